#include "material_names.hpp"

#include <set>

namespace realcam {

std::vector<std::string> material_names(const Scene& scene) {
    std::vector<std::string> names;
    std::set<std::string> taken;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const bool named = i < scene.material_names.size() && !scene.material_names[i].empty();
        const std::string wanted = named ? scene.material_names[i] : "material " + std::to_string(i);
        std::string name = wanted;
        for (int k = 2; !taken.insert(name).second; ++k) name = wanted + '.' + std::to_string(k);
        names.push_back(name);
    }
    return names;
}

}  // namespace realcam
