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
    std::string take(const std::string& name);

private:
    std::unordered_set<std::string> taken_;
    std::unordered_map<std::string, int> numbers_;
};

/// For an assembly whose instances have the names that a file gave them.
void make_names_distinct(Assembly& assembly);

/// Puts an object into a scene. What the object is itself made of becomes its parts, with names of the form name/part.
/// `names`: those of the assembly, which the new ones are kept apart from.
void add(Assembly& assembly, const Assembly& object, const Placement& placement, const std::string& name,
         DistinctNames& names);

}  // namespace REALCAM_NAMESPACE
