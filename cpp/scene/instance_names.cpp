#include "instance_names.hpp"

#include <utility>

namespace realcam {

std::string DistinctNames::take(const std::string& name) {
    if (name.empty() || taken_.insert(name).second) return name;
    // Counts on from the last number, because a file may hold a name a million times.
    int& number = numbers_.try_emplace(name, 1).first->second;
    std::string free;
    do free = name + '.' + std::to_string(++number);
    while (!taken_.insert(free).second);
    return free;
}

void make_names_distinct(Assembly& assembly) {
    DistinctNames names;
    for (Instance& instance : assembly.instances) instance.name = names.take(instance.name);
}

void add(Assembly& assembly, const Assembly& object, const AnimatedTransform& placement, const std::string& name,
         DistinctNames& names) {
    const std::vector<Instance> parts = object.instances;  // a copy, because the object may be the assembly itself
    const std::string own = names.take(name);
    std::ptrdiff_t whole = Instance::kNoWhole;
    if (!object.static_geometry->triangles.empty() || !object.static_geometry->points.empty()) {
        whole = std::ssize(assembly.instances);
        assembly.instances.push_back({object.static_geometry, placement.scene_from_object, own});
        assembly.instances.back().motion = placement.motion;
    }
    const std::ptrdiff_t first = std::ssize(assembly.instances);
    for (const Instance& part : parts) {
        Instance placed = part;
        placed.put(animated_transform(all_times({placement.motion.get(), part.motion.get()}),
                                      [&](double time) { return placement.at(time) * part.transform_at(time); }));
        placed.name = names.take(own + (own.empty() || part.name.empty() ? "" : "/") + part.name);
        placed.part_of = part.part_of == Instance::kNoWhole ? whole : first + part.part_of;
        assembly.instances.push_back(std::move(placed));
    }
}

}  // namespace realcam
