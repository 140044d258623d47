#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "bounding_box.hpp"
#include "build_light_tree.hpp"
#include "render_space_mesh.hpp"

namespace REALCAM_NAMESPACE {

/// A scene as kernels read it, relative to an origin near the camera, so that a scene far from its own origin loses
/// nothing. Objects are placed in frames of their own, which kernels reach through the instances; but one that is
/// large, and near the camera, is prepared as static geometry is, once for each instance of it. Owns the memory of
/// its view.
class RenderSpaceScene {
public:
    /// Throws Cancelled where `keep_going` returns false.
    RenderSpaceScene(Assembly assembly, Vec3d origin_m, const KeepGoing& keep_going = {})
        : assembly_(std::move(assembly)),
          origin_(origin_m),
          checkpoint_(keep_going),
          static_geometry_(*assembly_.static_geometry, relative_to(origin_m), LargeTriangles::cut, checkpoint_) {
        std::map<const Scene*, BoundingBox> boxes;
        std::map<std::pair<const Scene*, int>, std::uint32_t> shared;  // by those that are scaled about alike
        for (const Instance& instance : assembly_.instances) {
            checkpoint_.pass();
            const Scene& object = *instance.object;
            const auto [box, is_first] = boxes.try_emplace(&object);
            if (is_first) add_triangles(box->second, object, {});
            boxes_.push_back(box->second);
            const auto next = static_cast<std::uint32_t>(objects_.size());
            if (is_large_and_near(boxes_.back(), instance.scene_from_object)) {
                add_object(object, relative_to(origin_) * instance.scene_from_object, LargeTriangles::cut);
                object_of_.push_back(next);
            } else {
                const int about = static_cast<int>(std::floor(doublings(instance.scene_from_object) / kAlike));
                const auto [found, is_new] = shared.try_emplace({&object, about}, next);
                if (is_new)
                    add_object(object, own_frame(boxes_.back(), instance.scene_from_object), LargeTriangles::keep);
                object_of_.push_back(found->second);
            }
        }
        find_kind();
        if (kind_ != SceneKind::plain) {  // whose kernels read the finest level alone
            static_geometry_.add_texture_levels(checkpoint_);
            for (const auto& object : objects_) object->add_texture_levels(checkpoint_);
        }
        for (const auto& object : objects_) object_views_.push_back(object->view());
        const Environment& environment = assembly_.static_geometry->environment;
        environment_ = environment_tables(environment, checkpoint_);
        update_instances();
        checkpoint_ = Checkpoint();
    }

    /// Whether move can bring about an assembly: it has the same parts, and their frames are still good ones.
    bool can_move_to(const Assembly& assembly) const {
        if (!same_parts(assembly_, assembly)) return false;
        for (std::size_t i = 0; i < assembly.instances.size(); ++i) {
            const Affine<double>&now = assembly_.instances[i].scene_from_object,
                  &then = assembly.instances[i].scene_from_object;
            if (now == then) continue;
            if (is_static(i) || is_large_and_near(boxes_[i], then) ||
                std::fabs(doublings(objects_[object_of_[i]]->frame()) - doublings(then)) > kAlike)
                return false;
        }
        return true;
    }

    /// Gives instances other transforms, as can_move_to allows. Their triangles stay what they are, in their own
    /// frames.
    void move(const Assembly& assembly) {
        assembly_ = assembly;
        update_instances();
    }

    SceneView view() const {
        SceneView view{static_geometry_.view(), instances_view(), nullptr, nullptr, 0, 0, kind_, false, {}};
        const Scene& scene = *assembly_.static_geometry;
        const Environment& environment = scene.environment;
        view.objects = object_views_.data();
        view.object_count = static_cast<std::int32_t>(object_views_.size());
        view.suns = scene.suns.data();
        view.sun_count = static_cast<std::int32_t>(scene.suns.size());
        view.has_environment = environment.emits();
        view.environment = {environment.constant,
                            environment.pixels.empty() ? nullptr : environment.pixels.data(),
                            environment_.marginal_cdf.data(),
                            environment_.conditional_cdf.data(),
                            environment.width,
                            environment.height,
                            environment_.mean_luminance};
        return view;
    }

    InstancesView instances_view() const {
        InstancesView view{};
        view.instances = instances_.data();
        view.points = points_.data();
        view.areas = areas_.data();
        const bool has_lights = !light_tree_.nodes().empty();
        view.light_nodes = has_lights ? light_tree_.nodes().data() : nullptr;
        view.light_trails = has_lights ? light_tree_.trails().data() : nullptr;
        view.light_node_count = static_cast<std::int32_t>(light_tree_.nodes().size());
        view.instance_count = static_cast<std::int32_t>(instances_.size());
        view.point_count = static_cast<std::int32_t>(points_.size());
        view.area_count = static_cast<std::int32_t>(areas_.size());
        return view;
    }

    const Assembly& assembly() const { return assembly_; }
    Vec3d origin_m() const { return origin_; }
    const RenderSpaceMesh& static_geometry() const { return static_geometry_; }
    const std::vector<std::unique_ptr<RenderSpaceMesh>>& objects() const { return objects_; }
    const std::vector<InstanceView>& instances() const { return instances_; }

private:
    /// Objects of up to this size have float corners that are right to some micrometres, wherever the camera stands.
    static constexpr double kLarge_m = 100;
    /// As SplitTriangles: what is nearer than this part of its size is near.
    static constexpr double kNearShare = 1.0 / 128;

    bool is_large_and_near(const BoundingBox& box, const Affine<double>& map) const {
        if (box.empty()) return false;
        const double size = length(map.direction(box.high - box.low));
        const Vec3d near = map.point(box.nearest(map.inverse().point(origin_)));
        return size > kLarge_m && length(near - origin_) < kNearShare * size;
    }

    /// Of a length by a map, as a power of two.
    static double doublings(const Affine<double>& map) {
        return std::round(std::log2(std::fabs(map.determinant())) / 3);
    }
    /// So many doublings make no difference to a frame.
    static constexpr double kAlike = 10;

    /// About the middle, in units of about a metre as it is instanced: traversal takes triangles of less than 1e-9 of
    /// the unit for points.
    static Affine<double> own_frame(const BoundingBox& box, const Affine<double>& map) {
        Affine<double> frame;
        const double scale = std::exp2(doublings(map));
        frame.x.x = frame.y.y = frame.z.z = scale;
        if (!box.empty()) frame.origin = -scale * box.middle();
        return frame;
    }

    void add_object(const Scene& object, const Affine<double>& frame, LargeTriangles large) {
        objects_.push_back(std::make_unique<RenderSpaceMesh>(object, frame, large, checkpoint_));
        static_objects_.push_back(large == LargeTriangles::cut);
    }
    bool is_static(std::size_t instance) const { return static_objects_[object_of_[instance]]; }

    /// From the frame of an instance's object.
    Affine<double> render_from_object(std::size_t i) const {
        if (is_static(i)) return {};
        const Affine<double>& frame = objects_[object_of_[i]]->frame();
        const Affine<double>& map = assembly_.instances[i].scene_from_object;
        const double unit = 1 / frame.x.x;
        return {unit * map.x, unit * map.y, unit * map.z, map.point(-unit * frame.origin) - origin_};
    }

    void update_instances() {
        instances_.clear();
        points_.clear();
        areas_.clear();
        area_means_.clear();
        add_lights(static_geometry_, {}, nullptr);
        for (std::size_t i = 0; i < assembly_.instances.size(); ++i) {
            checkpoint_.pass();
            const Affine<double> exact = render_from_object(i);
            instances_.push_back(instance_view(exact, i));
            add_lights(*objects_[object_of_[i]], exact, &instances_.back());
        }
        light_tree_ = LightTree(points_, areas_, checkpoint_, area_means_);
    }

    InstanceView instance_view(const Affine<double>& exact, std::size_t i) const {
        const auto map = static_cast<Affine<float>>(exact);
        const InverseAffine<double> inverse = static_cast<Affine<double>>(map).inverse();
        const auto sum = [](double a, double b, double c) {
            return static_cast<float>(static_cast<double>(kMarginShare) * (std::fabs(a) + std::fabs(b) + std::fabs(c)));
        };
        const Vec3f margin = {sum(inverse.x.x, inverse.y.x, inverse.z.x), sum(inverse.x.y, inverse.y.y, inverse.z.y),
                              sum(inverse.x.z, inverse.y.z, inverse.z.z)};
        float reach = std::numeric_limits<float>::max();
        if (!is_static(i) && !boxes_[i].empty())
            reach = kMarginShare * static_cast<float>(length(assembly_.instances[i].scene_from_object.direction(
                                       boxes_[i].high - boxes_[i].low)));
        return {map,           static_cast<InverseAffine<float>>(inverse), margin, reach,
                object_of_[i], static_cast<std::int32_t>(areas_.size())};
    }

    void find_kind() {
        const auto add = [&](const Scene& scene) {
            for (const Material& m : scene.materials)
                kind_ = std::max(kind_, m.has_holes()  ? SceneKind::any
                                        : m.is_plain() ? SceneKind::plain
                                                       : SceneKind::opaque);
        };
        add(*assembly_.static_geometry);
        for (const Instance& instance : assembly_.instances) add(*instance.object);
    }

    static PointLight point_light(const ScenePointLight& from, Vec3d position, Vec3d axis) {
        PointLight light{static_cast<Vec3f>(position), from.intensity};
        if (!(length(axis) > 0)) return light;
        light.axis = static_cast<Vec3f>(normalized(axis));
        // A spot that ends without fading first would have an infinite slope: KHR_lights_punctual's bound.
        const double cos_outer = std::cos(from.outer_cone_rad);
        const double scale = 1 / std::max(1e-3, std::cos(from.inner_cone_rad) - cos_outer);
        light.cos_scale = static_cast<float>(scale);
        light.cos_offset = static_cast<float>(-cos_outer * scale);
        return light;
    }

    /// The emitters of a mesh where a map from its frame puts them. `instance`: none of static geometry.
    void add_lights(const RenderSpaceMesh& mesh, const Affine<double>& map, const InstanceView* instance) {
        const Scene& scene = mesh.scene();
        for (const ScenePointLight& p : scene.points)
            points_.push_back(point_light(p, map.point(mesh.frame().point(p.position_m)),
                                          map.direction(mesh.frame().direction(p.axis))));
        const InverseAffine<double> inverse = map.inverse();
        const std::uint32_t number = instance ? static_cast<std::uint32_t>(instances_.size() - 1) : kNoInstance;
        area_means_.insert(area_means_.end(), mesh.emission_means().begin(), mesh.emission_means().end());
        for (const std::uint32_t emitter : mesh.emitters()) {
            const Triangle& t = mesh.triangles()[emitter];
            const RenderSpaceMesh::Edges edges = mesh.edges(t);
            const Vec3d u = map.direction(edges.u), v = map.direction(edges.v);
            const TrianglePlane& plane = mesh.planes()[emitter];
            const Vec3d normal = inverse.normal_of(static_cast<Vec3d>(plane.normal));
            const Vec3f corner = static_cast<Vec3f>(map.point(edges.corner));
            const float margin = instance ? instance_margin(*instance, plane.margin, plane.normal,
                                                            static_cast<float>(1 / length(normal)), corner)
                                          : plane.margin;
            areas_.push_back({corner, static_cast<Vec3f>(u), static_cast<Vec3f>(v),
                              static_cast<Vec3f>(normalized(normal)), scene.materials[t.material].emits_on_both_sides,
                              scene.materials[t.material].emission, static_cast<float>(0.5 * length(cross(u, v))),
                              margin, emitter, number});
        }
    }

    Assembly assembly_;
    Vec3d origin_;
    Checkpoint checkpoint_;
    RenderSpaceMesh static_geometry_;
    std::vector<BoundingBox> boxes_;  ///< of each instance's object, as it is given
    std::vector<std::uint32_t> object_of_;  ///< of each instance, in:
    std::vector<std::unique_ptr<RenderSpaceMesh>> objects_;
    std::vector<bool> static_objects_;  ///< of each of them: placed as static geometry is, for one instance
    std::vector<MeshView> object_views_;
    std::vector<InstanceView> instances_;
    std::vector<PointLight> points_;
    std::vector<AreaLight> areas_;
    std::vector<float> area_means_;  ///< what maps make of their luminance
    LightTree light_tree_;
    SceneKind kind_ = SceneKind::plain;
    EnvironmentTables environment_;
};

}  // namespace REALCAM_NAMESPACE
