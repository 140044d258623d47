#pragma once
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "../error.hpp"
#include "../math/affine.hpp"
#include "scene.hpp"

namespace REALCAM_NAMESPACE {

/// An instance of an object: the triangles and point lights of another scene, without its suns and environment.
struct Instance {
    static constexpr std::ptrdiff_t kNoWhole = -1;

    std::shared_ptr<const Scene> object;
    Affine<double> scene_from_object;  ///< metres on both sides
    std::string name;  ///< for messages, and to find it by
    /// Number of the instance of which this one is a part, and with which it moves. A part comes after its whole.
    std::ptrdiff_t part_of = kNoWhole;
};

/// A scene as static geometry and instances of objects. A value: copies share what is
/// large. Backends know the last one again by these pointers, and keep all that they made of it where only transforms
/// differ.
struct Assembly {
    std::shared_ptr<const Scene> static_geometry;  ///< with the lights; may have no triangles where there are instances
    std::vector<Instance> instances;

    Assembly() = default;
    Assembly(std::shared_ptr<const Scene> scene) : static_geometry(std::move(scene)) {}
    Assembly(Scene scene) : static_geometry(std::make_shared<const Scene>(std::move(scene))) {}

    bool has_light() const {
        if (static_geometry->has_light()) return true;
        for (const Instance& instance : instances)
            if (instance.object->has_local_light()) return true;
        return false;
    }
    std::size_t triangle_count() const {
        std::size_t count = static_geometry->triangles.size();
        for (const Instance& instance : instances) count += instance.object->triangles.size();
        return count;
    }
};

/// Whether two assemblies are made of the same parts, of which some may have other transforms.
inline bool same_parts(const Assembly& a, const Assembly& b) {
    if (a.static_geometry != b.static_geometry || a.instances.size() != b.instances.size()) return false;
    for (std::size_t i = 0; i < a.instances.size(); ++i)
        if (a.instances[i].object != b.instances[i].object) return false;
    return true;
}

inline bool same_transforms(const Assembly& a, const Assembly& b) {
    for (std::size_t i = 0; i < a.instances.size(); ++i)
        if (a.instances[i].scene_from_object != b.instances[i].scene_from_object) return false;
    return true;
}

/// A name for messages.
inline std::string label(const Assembly& assembly, std::size_t instance) {
    const std::string& name = assembly.instances[instance].name;
    return "instance " + std::to_string(instance) + (name.empty() ? "" : " (\"" + name + "\")");
}

/// Why a map is no transform for an instance; empty where it is one.
inline std::string transform_error(const Affine<double>& map) {
    // Far inside of what float can do, and beyond what anybody has seen.
    constexpr double kFarthest_m = 1e12, kMost = 1e6, kLeast = 1e-6;
    constexpr double kLeastVolume =
        1e-4;  // of what the three would span at right angles: its inverse has digits to lose
    const auto within = [](double v) { return v >= kLeast && v <= kMost; };
    const double x = length(map.x), y = length(map.y), z = length(map.z);
    if (x == 0 || y == 0 || z == 0) return "a transform must keep three directions; this one makes the object flat";
    if (!within(x) || !within(y) || !within(z) || !(length(map.origin) <= kFarthest_m))
        return "a transform must be finite and scale each axis by 1e-6 to 1e6, to within 1e12 m";
    if (!(std::fabs(map.determinant()) > kLeastVolume * x * y * z))
        return "a transform must keep three directions; this one makes the object flat";
    return "";
}

/// Throws InputError where a transform is none.
inline void validate_transforms(const Assembly& assembly) {
    for (std::size_t i = 0; i < assembly.instances.size(); ++i) {
        const std::string why = transform_error(assembly.instances[i].scene_from_object);
        if (!why.empty()) throw InputError(label(assembly, i) + ": " + why);
    }
}

/// Throws InputError where there is nothing to be seen, or where a transform is none. What the parts hold is for
/// SceneChecks.
inline void validate(const Assembly& assembly) {
    if (!assembly.static_geometry || assembly.triangle_count() == 0)
        throw InputError("the scene is empty; at least one triangle is wanted");
    constexpr std::size_t kMostInstances = std::size_t{1} << 28;
    if (assembly.instances.size() > kMostInstances)
        throw InputError("a scene holds at most " + std::to_string(kMostInstances) + " instances");
    validate_transforms(assembly);
}

/// With a copy of static geometry that `change` has changed.
template <class Change>
Assembly with_static_geometry(Assembly assembly, Change&& change) {
    auto static_geometry = std::make_shared<Scene>(*assembly.static_geometry);
    change(*static_geometry);
    assembly.static_geometry = std::move(static_geometry);
    return assembly;
}

/// Puts an instance elsewhere, and with it its parts, and theirs.
inline void move(Assembly& assembly, std::size_t instance, const Affine<double>& scene_from_object) {
    const InverseAffine<double> back = assembly.instances[instance].scene_from_object.inverse();
    std::vector<bool> moves(assembly.instances.size(), false);
    moves[instance] = true;
    for (std::size_t i = instance + 1; i < assembly.instances.size(); ++i) {
        Instance& part = assembly.instances[i];
        if (part.part_of == Instance::kNoWhole || !moves[static_cast<std::size_t>(part.part_of)]) continue;
        moves[i] = true;
        const Affine<double>& map = part.scene_from_object;
        const Affine<double> within = {back.direction(map.x), back.direction(map.y), back.direction(map.z),
                                       back.point(map.origin)};
        part.scene_from_object = scene_from_object * within;
    }
    assembly.instances[instance].scene_from_object = scene_from_object;
}

}  // namespace REALCAM_NAMESPACE
