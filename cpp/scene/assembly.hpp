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

    /// False for an orthographic camera.
    bool has_pose() const { return vertical_field_rad > 0; }
    /// Returns scene_from_camera at a time in seconds.
    Affine<double> transform_at(double time_s) const { return motion ? motion->at(time_s) : scene_from_camera; }
};

/// Transform of an object: fixed, or animated by keyframes. Metres in both frames.
struct AnimatedTransform {
    Affine<double> scene_from_object;  ///< for an animated object: at time 0
    std::shared_ptr<const Motion> motion;  ///< null: not animated

    AnimatedTransform(const Affine<double>& map = {}) : scene_from_object(map) {}
    /// The keys must be valid (motion_error returns an empty string).
    AnimatedTransform(Motion keys)
        : scene_from_object(keys.at(0)), motion(std::make_shared<const Motion>(std::move(keys))) {}

    /// Returns scene_from_object at a time in seconds.
    Affine<double> at(double time_s) const { return motion ? motion->at(time_s) : scene_from_object; }
};

/// An instance of an object: the triangles and point lights of another scene, without its suns and environment.
struct Instance {
    static constexpr std::ptrdiff_t kNoParentInstance = -1;  ///< `part_of` of an instance without a parent

    std::shared_ptr<const Scene> object;
    Affine<double> scene_from_object;  ///< for an animated instance: at time 0
    std::string name;  ///< for messages and look-up; may be empty
    /// Index of the parent instance, with which this one moves, or kNoParentInstance. A part comes after its parent.
    std::ptrdiff_t part_of = kNoParentInstance;
    std::shared_ptr<const Motion> motion = nullptr;  ///< null: not animated

    /// Returns scene_from_object at a time in seconds.
    Affine<double> transform_at(double time_s) const { return motion ? motion->at(time_s) : scene_from_object; }
    /// Replaces scene_from_object and motion.
    void set_transform(const AnimatedTransform& transform);
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

    /// True if the static geometry or any instance emits light.
    bool has_light() const;
    /// True if any instance is animated, or its object deforms.
    bool moves() const {
        return std::any_of(instances.begin(), instances.end(), [](const Instance& i) { return i.motion != nullptr; }) ||
               deforms();
    }
    /// True if the object of any instance deforms.
    bool deforms() const {
        return std::any_of(instances.begin(), instances.end(),
                           [](const Instance& i) { return i.object->deformation != nullptr; });
    }
    /// Number of triangles of the static geometry and of all instances, each counted in full.
    std::size_t triangle_count() const;
};

/// True if two scenes share static geometry and objects; transforms may differ.
bool same_parts(const Assembly& a, const Assembly& b);

/// True if two instances have the same transform and motion.
bool same_transform(const Instance& a, const Instance& b);

/// True if all instances of two scenes have the same transforms and motions; the scenes must have equally many.
bool same_transforms(const Assembly& a, const Assembly& b);

/// Returns the instance's index and name, for messages: instance 3 ("car").
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

/// Returns the scene frozen at a time: every instance has a fixed transform, and every object a constant shape.
Assembly frozen_at(Assembly assembly, double time_s);

/// True if two transforms are equal up to rounding (1e-9, relative).
bool are_close(const Affine<double>& a, const Affine<double>& b);

/// Key times of several motions, sorted, without duplicates; null motions have no keys.
std::vector<double> all_times(std::initializer_list<const Motion*> motions);

/// Samples `at`, a function from a time in seconds to an Affine<double>: returns an animated transform with keys at
/// `times`; if `times` is empty, a fixed one, at(0).
template <class At>
AnimatedTransform animated_transform(const std::vector<double>& times, At&& at) {
    return times.empty() ? AnimatedTransform(at(0.0)) : AnimatedTransform(sampled_motion(times, at));
}

/// Sets the transform of an instance and moves its parts, recursively, along with it.
void move(Assembly& assembly, std::size_t instance, const AnimatedTransform& transform);

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
    std::unordered_map<std::string, int> numbers_;  ///< the last number that was appended to each name
};

/// Makes the instance names of a scene unique.
void make_names_distinct(Assembly& assembly);

/// Instances an object in a scene. The object's own instances become parts of the new one, named name/part. `names`:
/// the names that the scene already uses.
void add(Assembly& assembly, const Assembly& object, const AnimatedTransform& transform, const std::string& name,
         DistinctNames& names);

}  // namespace REALCAM_NAMESPACE
