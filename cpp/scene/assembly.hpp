#pragma once
#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "../error.hpp"
#include "../math/motion.hpp"
#include "scene.hpp"

namespace REALCAM_NAMESPACE {

/// Camera of a scene file: pose and field of view. The lens comes from realcam, not from the file.
struct SceneCamera {
    std::string name;
    /// The camera is at the origin of its frame and looks along -z, with y up; metres. For a moving camera: at time 0.
    Affine<double> scene_from_camera;
    /// Vertical field of view in radians. 0 for an orthographic camera, which no lens can reproduce.
    double vertical_field_rad = 0;
    std::shared_ptr<const Motion> motion = nullptr;  ///< null: not animated

    bool has_pose() const { return vertical_field_rad > 0; }
    Affine<double> transform_at(double time_s) const { return motion ? motion->at(time_s) : scene_from_camera; }
};

/// Animated transform of an object: a fixed transform or keyframes. Metres in both frames.
struct AnimatedTransform {
    Affine<double> scene_from_object;  ///< for an animated object: at time 0
    std::shared_ptr<const Motion> motion;  ///< null: not animated

    AnimatedTransform(const Affine<double>& map = {}) : scene_from_object(map) {}
    /// The keys must be valid (motion_error returns an empty string).
    AnimatedTransform(Motion keys)
        : scene_from_object(keys.at(0)), motion(std::make_shared<const Motion>(std::move(keys))) {}

    Affine<double> at(double time_s) const { return motion ? motion->at(time_s) : scene_from_object; }
};

/// An instance of an object: the triangles and point lights of another scene, without its suns and environment.
struct Instance {
    static constexpr std::ptrdiff_t kNoWhole = -1;

    std::shared_ptr<const Scene> object;
    Affine<double> scene_from_object;  ///< see AnimatedTransform
    std::string name;  ///< for messages and look-up
    /// Index of the parent instance, with which this one moves, or kNoWhole. A part comes after its parent.
    std::ptrdiff_t part_of = kNoWhole;
    std::shared_ptr<const Motion> motion = nullptr;

    Affine<double> transform_at(double time_s) const { return motion ? motion->at(time_s) : scene_from_object; }
    void put(const AnimatedTransform& placement);
};

/// A scene as static geometry and instances of objects, with value semantics: copies share the geometry. Backends
/// recognise the previous scene by these pointers and reuse everything that they built for it if only transforms
/// differ.
struct Assembly {
    /// With the suns and the environment; may have no triangles if there are instances.
    std::shared_ptr<const Scene> static_geometry;
    std::vector<Instance> instances;
    std::vector<SceneCamera> cameras;  ///< from the scene file

    Assembly() = default;
    Assembly(std::shared_ptr<const Scene> scene) : static_geometry(std::move(scene)) {}
    Assembly(Scene scene) : static_geometry(std::make_shared<const Scene>(std::move(scene))) {}

    bool has_light() const;
    bool moves() const {
        return std::any_of(instances.begin(), instances.end(), [](const Instance& i) { return i.motion != nullptr; });
    }
    std::size_t triangle_count() const;
};

/// True if two scenes share static geometry and objects; transforms may differ.
bool same_parts(const Assembly& a, const Assembly& b);

bool same_placement(const Instance& a, const Instance& b);

bool same_transforms(const Assembly& a, const Assembly& b);

/// Returns the instance's index and name, for messages.
std::string label(const Assembly& assembly, std::size_t instance);

/// Returns why a matrix is not a valid instance transform; empty if it is valid.
std::string transform_error(const Affine<double>& map);

/// Returns why keyframes are not a valid motion; empty if they are valid.
std::string motion_error(const Motion& motion);

/// Throws InputError if a transform or motion is invalid.
void validate_transforms(const Assembly& assembly);

/// Throws InputError if the scene has no triangles, too many instances or an invalid transform. SceneChecks checks the
/// contents of the geometry.
void validate(const Assembly& assembly);

/// Returns the scene with its static geometry replaced by a copy that `change(Scene&)` has modified.
template <class Change>
Assembly with_static_geometry(Assembly assembly, Change&& change) {
    auto static_geometry = std::make_shared<Scene>(*assembly.static_geometry);
    change(*static_geometry);
    assembly.static_geometry = std::move(static_geometry);
    return assembly;
}

/// Returns the scene frozen at a time: every instance has a fixed transform.
Assembly standing_at(Assembly assembly, double time_s);

/// True if two transforms are equal up to rounding (1e-9, relative).
bool are_close(const Affine<double>& a, const Affine<double>& b);

/// Key times of several motions, sorted, without duplicates; null motions have no keys.
std::vector<double> all_times(std::initializer_list<const Motion*> motions);

/// Animated transform with keys at `times`, where it equals at(time); fixed, at(0), if `times` is empty.
template <class At>
AnimatedTransform animated_transform(const std::vector<double>& times, At&& at) {
    return times.empty() ? AnimatedTransform(at(0.0)) : AnimatedTransform(sampled_motion(times, at));
}

/// Sets the transform or motion of an instance and moves its parts, recursively, along with it.
void move(Assembly& assembly, std::size_t instance, const AnimatedTransform& placement);

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
