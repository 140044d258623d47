#pragma once
#include <string>
#include <unordered_map>
#include <unordered_set>

#include "assembly.hpp"

namespace REALCAM_NAMESPACE {

/// Keeps the names of instances distinct, so that a name says which one is meant: of several that are called "car" the
/// first keeps that name, and the others become "car.2", "car.3" and so on. No name stays no name.
class DistinctNames {
public:
    DistinctNames() = default;
    explicit DistinctNames(const Assembly& assembly) {
        for (const Instance& instance : assembly.instances) taken_.insert(instance.name);
    }

    /// The name, or the first free one made of it; taken from now on.
    std::string take(const std::string& name) {
        if (name.empty() || taken_.insert(name).second) return name;
        // The count goes on from the last one, because a file may hold a name a million times.
        int& number = numbers_.try_emplace(name, 1).first->second;
        std::string free;
        do free = name + '.' + std::to_string(++number);
        while (!taken_.insert(free).second);
        return free;
    }

private:
    std::unordered_set<std::string> taken_;
    std::unordered_map<std::string, int> numbers_;
};

/// For an assembly whose instances have the names that a file gave them.
inline void make_names_distinct(Assembly& assembly) {
    DistinctNames names;
    for (Instance& instance : assembly.instances) instance.name = names.take(instance.name);
}

/// Puts an object into a scene. What the object is itself made of becomes its parts, with names of the form name/part.
/// `names`: those of the assembly, which the new ones are kept apart from.
inline void add(Assembly& assembly, const Assembly& object, const Placement& placement, const std::string& name,
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
        placed.put(placement_by(all_times({placement.motion.get(), part.motion.get()}),
                                [&](double time) { return placement.at(time) * part.transform_at(time); }));
        placed.name = names.take(own + (own.empty() || part.name.empty() ? "" : "/") + part.name);
        placed.part_of = part.part_of == Instance::kNoWhole ? whole : first + part.part_of;
        assembly.instances.push_back(std::move(placed));
    }
}

}  // namespace REALCAM_NAMESPACE
