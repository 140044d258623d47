#include "layers.hpp"

namespace realcam {

std::string layer_names() {
    std::string names;
    for (const LayerInfo& layer : kLayers) names += std::string(names.empty() ? "" : ", ") + layer.name;
    return names;
}

std::vector<std::string> names_of(LayerSet set) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < kLayers.size(); ++i)
        if (set.has(static_cast<Layer>(i))) names.emplace_back(kLayers[i].name);
    return names;
}

LayerSet layers_named(const std::vector<std::string>& names) {
    LayerSet set;
    for (const std::string& name : names) {
        if (name == "all") {
            set = LayerSet::all();
            continue;
        }
        std::size_t i = 0;
        while (i < kLayers.size() && name != kLayers[i].name) ++i;
        if (i == kLayers.size())
            throw InputError("unknown layer \"" + name.substr(0, 60) + "\"; expected all, or some of " + layer_names());
        set.add(static_cast<Layer>(i));
    }
    return set;
}

}  // namespace realcam
