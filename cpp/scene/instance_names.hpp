#pragma once
#include <string>
#include <unordered_map>
#include <unordered_set>

#include "assembly.hpp"

namespace REALCAM_NAMESPACE {

/// Makes instance names unique, so that a name identifies one instance: of several called "car" the first keeps that
/// name, and the others become "car.2", "car.3" and so on. Empty names stay empty.
class DistinctNames {
public:
    DistinctNames() = default;
    explicit DistinctNames(const Assembly& assembly) {
        for (const Instance& instance : assembly.instances) taken_.insert(instance.name);
    }

    /// Returns the name, or the first free numbered variant of it, and reserves it.
    std::string take(const std::string& name);

private:
    std::unordered_set<std::string> taken_;
    std::unordered_map<std::string, int> numbers_;
};

/// Makes the instance names of a scene unique.
void make_names_distinct(Assembly& assembly);

/// Instances an object in a scene. The object's own instances become parts of the new one, named name/part. `names`:
/// the names that the scene already uses.
void add(Assembly& assembly, const Assembly& object, const AnimatedTransform& placement, const std::string& name,
         DistinctNames& names);

}  // namespace REALCAM_NAMESPACE
