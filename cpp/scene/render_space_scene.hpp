#pragma once
#include <cmath>
#include <memory>
#include <vector>

#include "bounding_box.hpp"
#include "build_light_tree.hpp"
#include "light_tables.hpp"
#include "render_space_mesh.hpp"

namespace REALCAM_NAMESPACE {

/// A scene as kernels read it, relative to an origin near the camera, so that a scene far from its own origin loses
/// nothing. Objects are placed in frames of their own, which kernels reach through the instances; but one that is
/// large, and near the camera, is prepared as static geometry is, once for each instance of it. Owns the memory of
/// its view.
class RenderSpaceScene {
public:
    /// `exposure`: from when to when it is looked at. Throws Cancelled where `keep_going` returns false, and InputError
    /// for a motion that is too fast (exposure_keys).
    RenderSpaceScene(Assembly assembly, Vec3d origin_m, TimeInterval exposure = {}, const KeepGoing& keep_going = {});

    /// Whether move can bring about an assembly: it has the same parts, and their frames are still good ones.
    bool can_move_to(const Assembly& assembly) const;

    /// Gives instances other transforms, as can_move_to allows, or looks at them at another time. Their triangles stay
    /// what they are, in their own frames. Throws InputError as the constructor.
    void move(const Assembly& assembly, TimeInterval exposure = {});

    SceneView view() const;

    InstancesView instances_view() const;

    const Assembly& assembly() const { return assembly_; }
    Vec3d origin_m() const { return origin_; }
    const TimeInterval& exposure() const { return exposure_; }
    /// Whether anything moves during the exposure.
    bool moves() const { return !keys_.empty(); }
    const RenderSpaceMesh& static_geometry() const { return static_geometry_; }
    const std::vector<std::unique_ptr<RenderSpaceMesh>>& objects() const { return objects_; }
    const std::vector<InstanceView>& instances() const { return instances_; }
    const std::vector<Affine<float>>& keys() const { return keys_; }

private:
    /// Objects of up to this size have float corners that are right to some micrometres, wherever the camera stands.
    static constexpr double kLarge_m = 100;
    /// As SplitTriangles: what is nearer than this part of its size is near.
    static constexpr double kNearShare = 1.0 / 128;

    bool is_large_and_near(const BoundingBox& box, const Affine<double>& map) const;

    /// The scaling of a length by a map, as a power of two.
    static double doublings(const Affine<double>& map) {
        return std::round(std::log2(std::fabs(map.determinant())) / 3);
    }
    /// So many doublings make no difference to a frame.
    static constexpr double kAlike = 10;

    /// About the middle, in units of about a metre as it is instanced: traversal takes triangles of less than 1e-9 of
    /// the unit for points.
    static Affine<double> own_frame(const BoundingBox& box, const Affine<double>& map);

    void add_object(const Scene& object, const Affine<double>& frame, LargeTriangles large);
    bool is_static(std::size_t instance) const { return static_objects_[object_of_[instance]]; }

    /// The transform from the frame of an instance's object, whose own coordinates `map` takes into the scene.
    Affine<double> render_from_object(std::size_t i, const Affine<double>& map) const;

    void update_instances();

    /// The instance, its keys if it moves, and its lights.
    void add_instance(std::size_t i);

    /// Transforms of an instance at even times of the exposure; one where it does not move meanwhile.
    std::vector<Affine<double>> exposure_keys(std::size_t i) const;

    /// Makes margins serve at another key, too. Kernels find the inverse in float: each of its entries is off by some
    /// roundings of the products of two columns over the volume that the three span.
    void widen_margins(InstanceView& view, const Affine<double>& key, std::size_t i) const;

    /// Those of the lights from these numbers on, which are of one instance; of one that moves, around all places.
    void add_leaves(std::size_t first_point, std::size_t first_area, std::vector<LightLeaf>& points,
                    std::vector<LightLeaf>& areas) const;

    InstanceView instance_view(const Affine<double>& exact, std::size_t i) const;

    void find_kind();

    static PointLight point_light(const ScenePointLight& from, Vec3d position, Vec3d axis);

    /// The emitters of a mesh where a map from its frame puts them. `instance`: none of static geometry.
    void add_lights(const RenderSpaceMesh& mesh, const Affine<double>& map, const InstanceView* instance);

    Assembly assembly_;
    Vec3d origin_;
    TimeInterval exposure_;
    Checkpoint checkpoint_;
    RenderSpaceMesh static_geometry_;
    std::vector<BoundingBox> boxes_;  ///< of each instance's object, as it is given
    std::vector<std::uint32_t> object_of_;  ///< of each instance, in:
    std::vector<std::unique_ptr<RenderSpaceMesh>> objects_;
    std::vector<bool> static_objects_;  ///< of each of them: placed as static geometry is, for one instance
    std::vector<MeshView> object_views_;
    std::vector<InstanceView> instances_;
    std::vector<Affine<float>> keys_;  ///< of those that move
    std::vector<PointLight> points_;
    std::vector<AreaLight> areas_;
    std::vector<float> area_means_;  ///< what maps make of their luminance
    LightTree light_tree_;
    SceneKind kind_ = SceneKind::plain;  ///< as long as nothing moves
    EnvironmentTables environment_;
};

}  // namespace REALCAM_NAMESPACE
