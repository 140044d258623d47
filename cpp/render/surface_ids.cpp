#include "surface_ids.hpp"

#include <map>
#include <string>
#include <utility>

#include "../scene/material_names.hpp"

namespace realcam {

SurfaceIds::SurfaceIds(const Assembly& assembly) : objects_{"", "static geometry"}, materials_{""} {
    std::map<const Scene*, std::uint32_t> first;
    const auto first_of = [&](const Scene& scene) {
        const auto [entry, is_new] = first.try_emplace(&scene, static_cast<std::uint32_t>(materials_.size()));
        if (is_new)
            for (std::string& name : material_names(scene)) materials_.push_back(std::move(name));
        return entry->second;
    };
    first_material_.push_back(first_of(*assembly.static_geometry));
    for (std::size_t i = 0; i < assembly.instances.size(); ++i) {
        const Instance& instance = assembly.instances[i];
        objects_.push_back(instance.name.empty() ? "instance " + std::to_string(i) : instance.name);
        first_material_.push_back(first_of(*instance.object));
    }
}

}  // namespace realcam
