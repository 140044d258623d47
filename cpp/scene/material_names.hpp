#pragma once
#include <set>
#include <string>
#include <vector>

#include "scene.hpp"

namespace REALCAM_NAMESPACE {

/// A name for each material, all distinct: the file's, "material 3" for one without a name, "wood.2" for the second
/// "wood".
inline std::vector<std::string> material_names(const Scene& scene) {
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

}  // namespace REALCAM_NAMESPACE
