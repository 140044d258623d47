#pragma once
#include <cmath>
#include <memory>
#include <vector>

#include "../geometry/bounding_box.hpp"
#include "../lights/build_light_tree.hpp"
#include "../lights/light_tables.hpp"
#include "render_space_mesh.hpp"

namespace REALCAM_NAMESPACE {

/// Scene as kernels read it, in render space: relative to an origin near the camera, so that a scene far from its own
/// origin loses no precision. Objects have frames of their own, which kernels reach through the instances; but an
/// object that is large and near the camera is prepared like static geometry, once for each of its instances. Owns the
/// memory of its view.
class RenderSpaceScene {
public:
    /// `origin_m`: origin of render space in the scene; `exposure`: shutter interval. Throws Cancelled if `keep_going`
    /// returns false, and InputError for a motion that is too fast (exposure_keys).
    RenderSpaceScene(Assembly assembly, Vec3d origin_m, TimeInterval exposure = {}, const KeepGoing& keep_going = {});

    /// True if move() can update to this scene: it has the same static geometry and objects, and the objects' frames
    /// still have a suitable scale and position.
    bool can_move_to(const Assembly& assembly) const;

    /// Updates the instances' transforms (see can_move_to) or the exposure interval; meshes are kept. Throws InputError
    /// like the constructor.
    void move(const Assembly& assembly, TimeInterval exposure = {});

    SceneView view() const;

    /// The part of the view that move() changes.
    InstancesView instances_view() const;

    const Assembly& assembly() const { return assembly_; }
    /// Origin of render space in the scene.
    Vec3d origin_m() const { return origin_; }
    const TimeInterval& exposure() const { return exposure_; }
    /// True if anything moves during the exposure.
    bool moves() const { return !keys_.empty(); }
    const RenderSpaceMesh& static_geometry() const { return static_geometry_; }
    /// Meshes of the objects, SceneView::objects.
    const std::vector<std::unique_ptr<RenderSpaceMesh>>& objects() const { return objects_; }
    const std::vector<InstanceView>& instances() const { return instances_; }
    const std::vector<Affine<float>>& keys() const { return keys_; }

private:
    /// Up to this size an object's float corners are accurate to a few micrometres, wherever the camera is.
    static constexpr double kLarge_m = 100;
    /// An object is near if its distance is below this fraction of its size; see SplitTriangles.
    static constexpr double kNearRatio = 1.0 / 128;

    /// True if an object with this bounding box, in object space, is so large and so near to the origin that its
    /// triangles must be split. `map`: from object space to scene space.
    bool is_large_and_near(const BoundingBox& box, const Affine<double>& map) const;

    /// Binary logarithm of a transform's scale factor, rounded to an integer.
    static double log2_scale(const Affine<double>& map) {
        return std::round(std::log2(std::fabs(map.determinant())) / 3);
    }
    /// Instances whose log2_scale differs by up to this number may share a frame.
    static constexpr double kMaxScaleDifference = 10;

    /// Returns the frame of an object, as a transform from object space: centred on its box, scaled so that a unit is
    /// about a metre at the instance's scale. Traversal treats triangles smaller than 1e-9 units as points. `map`: from
    /// object space to scene space.
    static Affine<double> object_frame(const BoundingBox& box, const Affine<double>& map);

    /// Appends the mesh of an object. `frame`: transform from object space.
    void add_object(const Scene& object, const Affine<double>& frame, LargeTriangles large);
    /// True if an instance is prepared like static geometry.
    bool is_static(std::size_t instance) const { return static_objects_[object_of_[instance]]; }

    /// Transform from the frame of instance i's object to render space; `map`: from object space to scene space.
    Affine<double> render_from_object(std::size_t i, const Affine<double>& map) const;

    /// Recomputes everything that depends on the instances' transforms: instances, keys, lights and the light tree.
    void update_instances();

    /// Sets the air. Its box encloses the instances at time 0, so that it is the same in all frames of a video.
    void set_air();

    /// Appends the instance, its keys if it moves, and its lights.
    void add_instance(std::size_t i);

    /// Transforms of an instance at equally spaced times of the exposure; a single one if it does not move meanwhile.
    std::vector<Affine<double>> exposure_keys(std::size_t i) const;

    /// Extends an instance's margins to those at another key. Kernels invert interpolated transforms in float; each
    /// entry of the inverse has an error of some roundings of the product of two column lengths over the volume spanned
    /// by the three columns.
    void widen_margins(InstanceView& view, const Affine<double>& key, std::size_t i) const;

    /// Appends the leaves of the lights from these indices on, which belong to the last instance; the bounds of a
    /// moving light enclose its positions at all keys.
    void add_leaves(std::size_t first_point, std::size_t first_area, std::vector<LightLeaf>& points,
                    std::vector<LightLeaf>& areas) const;

    /// Returns the view of instance i, without keys. `transform`: its exact transform to render space.
    InstanceView instance_view(const Affine<double>& transform, std::size_t i) const;

    /// Sets kind_ and has_scattering_media_ by the materials of all geometry and the air.
    void find_kind();

    /// Converts a light. `position`, `axis`: of the light, transformed.
    static PointLight point_light(const ScenePointLight& light, Vec3d position, Vec3d axis);

    /// Appends the lights of a mesh, transformed by `map` from the mesh's frame to render space. `instance`: null for
    /// static geometry.
    void add_lights(const RenderSpaceMesh& mesh, const Affine<double>& map, const InstanceView* instance);

    Assembly assembly_;
    Vec3d origin_;
    TimeInterval exposure_;
    Checkpoint checkpoint_;
    RenderSpaceMesh static_geometry_;
    BoundingBox static_box_;  ///< bounding box of the static geometry in scene space; empty if there is no air
    AirView air_;
    bool has_scattering_media_ = false;
    std::vector<BoundingBox> boxes_;  ///< for each instance: bounding box of its object, in object space
    std::vector<std::uint32_t> object_of_;  ///< for each instance: index in objects_
    std::vector<std::unique_ptr<RenderSpaceMesh>> objects_;
    std::vector<bool> static_objects_;  ///< for each object: prepared like static geometry, for a single instance
    std::vector<MeshView> object_views_;
    std::vector<InstanceView> instances_;
    std::vector<Affine<float>> keys_;  ///< keys of all moving instances, one instance after the other
    std::vector<PointLight> points_;
    std::vector<AreaLight> areas_;
    std::vector<float> area_means_;  ///< for each area light: mean factor of its luminance (emission_means)
    LightTree light_tree_;
    SceneKind kind_ = SceneKind::plain;  ///< kind of the scene if nothing moves
    EnvironmentTables environment_;
};

}  // namespace REALCAM_NAMESPACE
