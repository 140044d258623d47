#pragma once
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "bounding_box.hpp"
#include "placed_mesh.hpp"

namespace REALCAM_NAMESPACE {

/// A scene as kernels read it, relative to an origin near the camera, so that a scene far from its own origin loses
/// nothing. Objects are placed in frames of their own, which kernels reach through the instances. Owns the memory of
/// its view.
class PlacedScene {
public:
    PlacedScene(Assembly assembly, Vec3d origin_m)
        : assembly_(std::move(assembly)), origin_(origin_m), ground_(*assembly_.ground, origin_m) {
        for (const Instance& instance : assembly_.instances) object_of_.push_back(object_number(instance.object.get()));
        for (const Scene* part : parts_) add_triangles(boxes_.emplace_back(), *part, {});
        const std::vector<Frame> frames = frames_for(assembly_);
        for (std::size_t i = 0; i < parts_.size(); ++i)
            objects_.push_back(std::make_unique<PlacedMesh>(
                *parts_[i], frames[i].origin_m, frames[i].large_and_near ? LargeTriangles::cut : LargeTriangles::keep));
        for (const auto& object : objects_) object_views_.push_back(object->view());
        const Environment& environment = assembly_.ground->environment;
        if (!environment.pixels.empty()) environment_ = environment_tables(environment);
        place_instances();
    }

    /// Whether move can bring about an assembly: it has the same parts, and their frames are still good ones.
    bool can_move_to(const Assembly& assembly) const {
        if (!same_parts(assembly_, assembly)) return false;
        const std::vector<Frame> frames = frames_for(assembly);
        for (std::size_t i = 0; i < frames.size(); ++i)
            if (frames[i].large_and_near && frames[i].origin_m != objects_[i]->origin_m()) return false;
        return true;
    }

    /// Objects to other places. Their triangles stay what they are, in their own frames.
    void move(const Assembly& assembly) {
        assembly_ = assembly;
        place_instances();
    }

    SceneView view() const {
        SceneView view{ground_.view(), places(), nullptr, nullptr, 0, 0, false, {}};
        const Scene& scene = *assembly_.ground;
        const Environment& environment = scene.environment;
        view.objects = object_views_.data();
        view.object_count = static_cast<std::int32_t>(object_views_.size());
        view.suns = scene.suns.data();
        view.sun_count = static_cast<std::int32_t>(scene.suns.size());
        view.has_environment = environment.shines();
        view.environment = {environment.constant,
                            environment.pixels.empty() ? nullptr : environment.pixels.data(),
                            environment_.marginal_cdf.data(),
                            environment_.conditional_cdf.data(),
                            environment.width,
                            environment.height};
        return view;
    }

    PlacesView places() const {
        PlacesView view{};
        view.instances = instances_.data();
        view.points = points_.data();
        view.areas = areas_.data();
        view.area_cdf = area_cdf_.empty() ? nullptr : area_cdf_.data();
        view.instance_count = static_cast<std::int32_t>(instances_.size());
        view.point_count = static_cast<std::int32_t>(points_.size());
        view.area_count = static_cast<std::int32_t>(areas_.size());
        return view;
    }

    const Assembly& assembly() const { return assembly_; }
    Vec3d origin_m() const { return origin_; }
    const PlacedMesh& ground() const { return ground_; }
    const std::vector<std::unique_ptr<PlacedMesh>>& objects() const { return objects_; }
    const std::vector<InstanceView>& instances() const { return instances_; }

private:
    /// Objects of up to this size have float corners that are right to some micrometres, wherever the camera stands.
    static constexpr double kLarge_m = 100;
    /// As SplitTriangles: what is nearer than this part of its size is near.
    static constexpr double kNearShare = 1.0 / 128;

    /// Where an object's own positions count from.
    struct Frame {
        Vec3d origin_m;
        bool large_and_near;
    };

    std::uint32_t object_number(const Scene* part) {
        const auto number = static_cast<std::uint32_t>(std::find(parts_.begin(), parts_.end(), part) - parts_.begin());
        if (number == parts_.size()) parts_.push_back(part);
        return number;
    }

    /// Their middles; but of a large object before the camera the point that is nearest to it.
    std::vector<Frame> frames_for(const Assembly& assembly) const {
        std::vector<Frame> frames;
        for (const BoundingBox& box : boxes_) frames.push_back({box.empty() ? Vec3d{0, 0, 0} : box.middle(), false});
        std::vector<double> nearest_m(parts_.size(), BoundingBox::kNone);
        for (std::size_t i = 0; i < assembly.instances.size(); ++i) {
            const Affine<double>& map = assembly.instances[i].scene_from_object;
            const BoundingBox& box = boxes_[object_of_[i]];
            if (box.empty()) continue;
            const Vec3d near = box.nearest(map.inverse().point(origin_));
            const double distance = length(map.point(near) - origin_), size = length(map.direction(box.high - box.low));
            if (!(size > kLarge_m && distance < kNearShare * size && distance < nearest_m[object_of_[i]])) continue;
            nearest_m[object_of_[i]] = distance;
            frames[object_of_[i]] = {near, true};
        }
        return frames;
    }

    void place_instances() {
        instances_.clear();
        points_.clear();
        areas_.clear();
        AreaLights lights;
        add_lights(ground_, {}, 0, lights);
        for (std::size_t i = 0; i < assembly_.instances.size(); ++i) {
            const PlacedMesh& object = *objects_[object_of_[i]];
            Affine<double> exact = assembly_.instances[i].scene_from_object;
            exact.origin = exact.point(object.origin_m()) - origin_;
            const auto map = static_cast<Affine<float>>(exact);
            const InverseAffine<double> inverse = static_cast<Affine<double>>(map).inverse();
            const double shrinkage = std::sqrt(dot(inverse.x, inverse.x) + dot(inverse.y, inverse.y) +
                                               dot(inverse.z, inverse.z));  // of the thinnest direction, at least
            instances_.push_back({map, static_cast<InverseAffine<float>>(inverse),
                                  static_cast<float>(static_cast<double>(kMarginShare) * shrinkage), object_of_[i]});
            add_lights(object, exact, instances_.back().margin, lights);
        }
        area_cdf_ = area_light_cdf(areas_, lights.areas, lights.materials, lights.material_count);
    }

    /// What the choice among area lights has to know of each.
    struct AreaLights {
        std::vector<double> areas;
        std::vector<std::uint32_t> materials;
        std::size_t material_count = 0;
    };

    /// The lamps of a mesh where a map from its frame puts them. `margin`: see InstanceView.
    void add_lights(const PlacedMesh& mesh, const Affine<double>& map, float margin, AreaLights& lights) {
        const Scene& scene = mesh.scene();
        for (const PlacedPointLight& p : scene.points)
            points_.push_back({static_cast<Vec3f>(map.point(p.position_m - mesh.origin_m())), p.intensity});
        const InverseAffine<double> inverse = map.inverse();
        for (const std::uint32_t lamp : mesh.lamps()) {
            const Triangle& t = mesh.triangles()[lamp];
            const PlacedMesh::Edges edges = mesh.edges(t);
            const Vec3d corner = map.point(edges.corner), u = map.direction(edges.u), v = map.direction(edges.v);
            const double area = 0.5 * length(cross(u, v));
            if (!(area > 0)) continue;
            const TrianglePlane& plane = mesh.planes()[lamp];
            const Vec3d normal = inverse.normal_of(static_cast<Vec3d>(plane.normal));
            const Vec3f placed = static_cast<Vec3f>(corner);
            const float reach = largest_of(placed) + largest_of(static_cast<Vec3f>(map.origin));
            areas_.push_back({placed, static_cast<Vec3f>(u), static_cast<Vec3f>(v),
                              static_cast<Vec3f>(normalized(normal)), scene.materials[t.material].emission, 0.0f,
                              (plane.margin + margin * reach) / static_cast<float>(length(normal))});
            lights.areas.push_back(area);
            lights.materials.push_back(static_cast<std::uint32_t>(lights.material_count) + t.material);
        }
        lights.material_count += scene.materials.size();
    }

    static float largest_of(Vec3f p) { return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}); }

    Assembly assembly_;
    Vec3d origin_;
    PlacedMesh ground_;
    std::vector<const Scene*> parts_;  ///< the objects, each once
    std::vector<BoundingBox> boxes_;  ///< of each, as it is given
    std::vector<std::uint32_t> object_of_;  ///< of each instance
    std::vector<std::unique_ptr<PlacedMesh>> objects_;
    std::vector<MeshView> object_views_;
    std::vector<InstanceView> instances_;
    std::vector<PointLight> points_;
    std::vector<AreaLight> areas_;
    std::vector<float> area_cdf_;
    EnvironmentTables environment_;
};

}  // namespace REALCAM_NAMESPACE
