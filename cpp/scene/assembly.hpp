#pragma once
#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "../error.hpp"
#include "../math/motion.hpp"
#include "scene.hpp"
#include "scene_camera.hpp"

namespace REALCAM_NAMESPACE {

/// Where an object is in the scene, or how it moves there. Metres on both sides.
struct Placement {
    Affine<double> scene_from_object;  ///< of what moves, at time 0
    std::shared_ptr<const Motion> motion;  ///< null: it stays where it is

    Placement(const Affine<double>& map = {}) : scene_from_object(map) {}
    /// The keys are a motion (motion_error).
    Placement(Motion keys) : scene_from_object(keys.at(0)), motion(std::make_shared<const Motion>(std::move(keys))) {}

    Affine<double> at(double time_s) const { return motion ? motion->at(time_s) : scene_from_object; }
};

/// An instance of an object: the triangles and point lights of another scene, without its suns and environment.
struct Instance {
    static constexpr std::ptrdiff_t kNoWhole = -1;

    std::shared_ptr<const Scene> object;
    Affine<double> scene_from_object;  ///< see Placement
    std::string name;  ///< for messages, and to find it by
    /// Number of the instance of which this one is a part, and with which it moves. A part comes after its whole.
    std::ptrdiff_t part_of = kNoWhole;
    std::shared_ptr<const Motion> motion = nullptr;

    Affine<double> transform_at(double time_s) const { return motion ? motion->at(time_s) : scene_from_object; }
    void put(const Placement& placement);
};

/// A scene as static geometry and instances of objects. A value: copies share what is
/// large. Backends know the last one again by these pointers, and keep all that they made of it where only transforms
/// differ.
struct Assembly {
    std::shared_ptr<const Scene> static_geometry;  ///< with the lights; may have no triangles where there are instances
    std::vector<Instance> instances;
    std::vector<SceneCamera> cameras;  ///< that its file brings along

    Assembly() = default;
    Assembly(std::shared_ptr<const Scene> scene) : static_geometry(std::move(scene)) {}
    Assembly(Scene scene) : static_geometry(std::make_shared<const Scene>(std::move(scene))) {}

    bool has_light() const;
    bool moves() const {
        return std::any_of(instances.begin(), instances.end(), [](const Instance& i) { return i.motion != nullptr; });
    }
    std::size_t triangle_count() const;
};

/// Whether two assemblies are made of the same parts, of which some may have other transforms.
bool same_parts(const Assembly& a, const Assembly& b);

bool same_placement(const Instance& a, const Instance& b);

bool same_transforms(const Assembly& a, const Assembly& b);

/// A name for messages.
std::string label(const Assembly& assembly, std::size_t instance);

/// Why a map is no transform for an instance; empty where it is one.
std::string transform_error(const Affine<double>& map);

/// Why keys are no motion for an instance; empty where they are one.
std::string motion_error(const Motion& motion);

/// Throws InputError where a transform is none.
void validate_transforms(const Assembly& assembly);

/// Throws InputError where there is nothing to be seen, or where a transform is none. What the parts hold is for
/// SceneChecks.
void validate(const Assembly& assembly);

/// With a copy of static geometry that `change` has changed.
template <class Change>
Assembly with_static_geometry(Assembly assembly, Change&& change) {
    auto static_geometry = std::make_shared<Scene>(*assembly.static_geometry);
    change(*static_geometry);
    assembly.static_geometry = std::move(static_geometry);
    return assembly;
}

/// The scene as it stands at a time.
Assembly standing_at(Assembly assembly, double time_s);

/// But for roundings.
bool are_close(const Affine<double>& a, const Affine<double>& b);

/// The times of the keys of several motions; null: none.
std::vector<double> all_times(std::initializer_list<const Motion*> motions);

/// What moves as `at`, a function of the time, says. `times`: of the keys that this wants; none: it stays where it is.
template <class At>
Placement placement_by(const std::vector<double>& times, At&& at) {
    return times.empty() ? Placement(at(0.0)) : Placement(sampled_motion(times, at));
}

/// Puts an instance elsewhere, or lets it move, and with it its parts, and theirs.
void move(Assembly& assembly, std::size_t instance, const Placement& placement);

}  // namespace REALCAM_NAMESPACE
