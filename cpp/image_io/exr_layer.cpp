#include "exr_layer.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "../error.hpp"
#include "../io/text/printable.hpp"

namespace realcam::image_io {
namespace {

/// Names, in lower case, of the layer with the complete light: the part's name, or the component after the last dot.
constexpr std::string_view kBeautyNames[] = {"beauty", "combined", "rgba", "rgb", "color", "colour", "main", "final"};

/// Lower-case channel names of red, green and blue, or of X, Y and Z.
constexpr std::array<std::string_view, 3> kColourNames[] = {{"r", "g", "b"}, {"red", "green", "blue"}, {"x", "y", "z"}};
constexpr std::size_t kTristimulus = 2;  // index of X, Y and Z in kColourNames

std::string lower(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

std::string last_component(const std::string& name) {
    return name.substr(name.rfind('.') + 1);  // npos + 1 is 0
}

/// Layer of an OpenEXR file: the channels of one prefix in one part.
struct FileLayer {
    std::string name;  // part name and prefix; empty: channels without a prefix in a file of one part
    std::size_t part;  // index
    std::vector<std::pair<std::string, int>> channels =
        {};  // names in lower case without the prefix, and indices in the part
    bool has_whole_numbers = false;

    /// Index of a channel in its part; -1 if the layer does not have it.
    int find(std::string_view channel) const {
        for (const auto& [name, index] : channels)
            if (name == channel) return index;
        return -1;
    }
    /// Index of the alpha channel; -1 if there is none.
    int alpha() const { return std::max(find("a"), find("alpha")); }

    /// Returns the channels of red, green and blue, or of X, Y and Z; an empty list if there are none. Channels X, Y
    /// and Z with a prefix are not tristimulus values but vectors.
    std::vector<int> colours() const {
        for (const auto& names : kColourNames) {
            if (&names == &kColourNames[kTristimulus] && !name.empty()) continue;
            std::vector<int> found;
            for (const std::string_view colour : names) found.push_back(find(colour));
            if (std::ranges::find(found, -1) == found.end()) return found;
        }
        return {};
    }

    /// Returns the luminance channel, or the only channel other than alpha unless it is a depth; else an empty list.
    std::vector<int> grey() const {
        if (const int y = find("y"); y >= 0) return {y};
        std::vector<int> others;
        for (const auto& [channel, index] : channels)
            if (index != alpha() && channel != "z" && channel != "depth") others.push_back(index);
        return others.size() == 1 ? others : std::vector<int>{};
    }

    /// Returns the channels of ExrLayer; an empty list if the layer is not a picture.
    std::vector<int> picture() const {
        std::vector<int> found = colours().empty() ? grey() : colours();
        if (!found.empty() && alpha() >= 0) found.push_back(alpha());
        return found;
    }
};

/// Returns the flat layers, in the order of the file.
std::vector<FileLayer> layers_of(const std::vector<EncodedHeader>& parts) {
    std::vector<FileLayer> layers;
    for (std::size_t p = 0; p < parts.size(); ++p) {
        if (parts[p].is_deep || parts[p].depth > 1) continue;
        const std::string part_name = parts.size() > 1 ? parts[p].part_name : "";
        for (std::size_t c = 0; c < parts[p].channel_names.size(); ++c) {
            const std::string& channel = parts[p].channel_names[c].name;
            const std::size_t dot = channel.rfind('.');
            std::string prefix = dot == std::string::npos ? "" : channel.substr(0, dot);
            const bool includes_part_name = prefix == part_name || prefix.starts_with(part_name + ".");
            std::string name = prefix.empty()                            ? part_name
                               : part_name.empty() || includes_part_name ? prefix
                                                                         : part_name + "." + prefix;
            auto layer =
                std::ranges::find_if(layers, [&](const FileLayer& l) { return l.part == p && l.name == name; });
            if (layer == layers.end()) layer = layers.insert(layers.end(), FileLayer{std::move(name), p});
            layer->channels.emplace_back(lower(last_component(channel)), static_cast<int>(c));
            layer->has_whole_numbers |= parts[p].channel_names[c].is_number;
        }
    }
    return layers;
}

/// Lists the names of layers for a message.
std::string names_of(const std::vector<const FileLayer*>& layers) {
    constexpr std::size_t kMaxListed = 12;
    std::string out;
    for (std::size_t i = 0; i < std::min(kMaxListed, layers.size()); ++i)
        out += (i > 0 ? ", " : "") + (layers[i]->name.empty() ? "R, G and B" : io::in_quotes(layers[i]->name));
    return out + (layers.size() > kMaxListed ? " and " + std::to_string(layers.size() - kMaxListed) + " more" : "");
}

/// Returns the layers for which the predicate is true.
template <class Predicate>
std::vector<const FileLayer*> filtered(const std::vector<const FileLayer*>& layers, Predicate predicate) {
    std::vector<const FileLayer*> out;
    std::ranges::copy_if(layers, std::back_inserter(out), [&](const FileLayer* layer) { return predicate(*layer); });
    return out;
}

/// True if the layer has a name with which renderers denote the complete light.
bool is_beauty(const FileLayer& layer) {
    return std::ranges::find(kBeautyNames, lower(last_component(layer.name))) != std::end(kBeautyNames);
}

/// Returns the layer to read among those that are pictures (see choose_layer). Throws Error.
const FileLayer& select_layer(const std::vector<const FileLayer*>& pictures, const std::string& requested) {
    if (!requested.empty()) {
        const auto named = filtered(pictures, [&](const FileLayer& l) { return lower(l.name) == lower(requested); });
        if (named.size() == 1) return *named[0];
        throw Error((named.empty() ? "has no layer " : "has several layers ") + io::in_quotes(requested) +
                    "; its layers are " + names_of(pictures));
    }
    // Cryptomatte layers are excluded: they store hashes as red, green and blue.
    const auto light = filtered(pictures, [](const FileLayer& l) {
        return !lower(l.name).starts_with("crypto") && !lower(last_component(l.name)).starts_with("crypto");
    });
    const auto coloured = filtered(light, [](const FileLayer& l) { return !l.colours().empty(); });
    for (const auto& candidates : {filtered(coloured, [](const FileLayer& l) { return l.name.empty(); }),
                                   filtered(coloured, is_beauty), coloured, filtered(light, is_beauty), light}) {
        if (candidates.size() == 1) return *candidates[0];
        if (candidates.size() > 1)
            throw Error("has several layers: " + names_of(candidates) + "; choose one of them (environment_layer)");
    }
    throw Error("has no layer with R, G and B");
}

}  // namespace

ExrLayer choose_layer(const std::vector<EncodedHeader>& parts, const std::string& name) {
    const std::vector<FileLayer> layers = layers_of(parts);
    std::vector<const FileLayer*> pictures;
    for (const FileLayer& layer : layers)
        if (!layer.picture().empty()) pictures.push_back(&layer);
    // Id layers have whole numbers and are ignored; if there are no others, the error message names the reason.
    const auto light = filtered(pictures, [](const FileLayer& l) { return !l.has_whole_numbers; });
    const FileLayer& layer = select_layer(!name.empty() || light.empty() ? pictures : light, name);
    std::vector<int> channels = layer.picture();
    for (const int channel : channels)
        if (parts[layer.part].channel_names[static_cast<std::size_t>(channel)].is_number)
            throw Error("has whole numbers (UINT) in its channels, which are not light; expected HALF or FLOAT");
    return {layer.part, std::move(channels)};
}

}  // namespace realcam::image_io
