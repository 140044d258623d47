#include "render_space_scene.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "../../math/motion.hpp"
#include "../lights/light.hpp"

namespace realcam {

RenderSpaceScene::RenderSpaceScene(Assembly assembly, Vec3d origin_m, TimeInterval exposure,
                                   const KeepGoing& keep_going)
    : assembly_(std::move(assembly)),
      origin_(origin_m),
      exposure_(exposure),
      checkpoint_(keep_going),
      static_geometry_(*assembly_.static_geometry, relative_to(origin_m), LargeTriangles::cut, checkpoint_) {
    std::map<const Scene*, BoundingBox> boxes;
    // By object and coarse scale, so that instances of similar scale share one mesh.
    std::map<std::pair<const Scene*, int>, std::uint32_t> shared;
    for (const Instance& instance : assembly_.instances) {
        checkpoint_.pass();
        const Scene& object = *instance.object;
        const auto [box, is_first] = boxes.try_emplace(&object);
        if (is_first) add_triangles(box->second, object, {});
        boxes_.push_back(box->second);
        const auto next = static_cast<std::uint32_t>(objects_.size());
        if (!instance.motion && is_large_and_near(boxes_.back(), instance.scene_from_object)) {
            add_object(object, relative_to(origin_) * instance.scene_from_object, LargeTriangles::cut);
            object_of_.push_back(next);
        } else {
            const int scale_class =
                static_cast<int>(std::floor(log2_scale(instance.scene_from_object) / kMaxScaleDifference));
            const auto [found, is_new] = shared.try_emplace({&object, scale_class}, next);
            if (is_new)
                add_object(object, object_frame(boxes_.back(), instance.scene_from_object), LargeTriangles::keep);
            object_of_.push_back(found->second);
        }
    }
    find_kind();
    if (assembly_.static_geometry->air.is_present()) add_triangles(static_box_, *assembly_.static_geometry, {});
    static_geometry_.add_texture_levels(checkpoint_);
    for (const auto& object : objects_) object->add_texture_levels(checkpoint_);
    for (const auto& object : objects_) object_views_.push_back(object->view());
    const Environment& environment = assembly_.static_geometry->environment;
    environment_ = environment_tables(environment, checkpoint_);
    update_instances();
    checkpoint_ = Checkpoint();
}

bool RenderSpaceScene::can_move_to(const Assembly& assembly) const {
    if (!same_parts(assembly_, assembly)) return false;
    for (std::size_t i = 0; i < assembly.instances.size(); ++i) {
        if (same_transform(assembly_.instances[i], assembly.instances[i])) continue;
        const Affine<double>& new_transform = assembly.instances[i].scene_from_object;
        if (is_static(i) || is_large_and_near(boxes_[i], new_transform) ||
            std::fabs(log2_scale(objects_[object_of_[i]]->frame()) - log2_scale(new_transform)) > kMaxScaleDifference)
            return false;
    }
    return true;
}

void RenderSpaceScene::move(const Assembly& assembly, TimeInterval exposure) {
    assembly_ = assembly;
    exposure_ = exposure;
    update_instances();
}

SceneView RenderSpaceScene::view() const {
    SceneView view{static_geometry_.view(), instances_view(), nullptr, nullptr, 0, 0, false, {}};
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

InstancesView RenderSpaceScene::instances_view() const {
    InstancesView view{};
    view.kind = moves() ? SceneKind::any : kind_;
    view.instances = instances_.data();
    view.keys = keys_.data();
    view.points = points_.data();
    view.areas = areas_.data();
    const bool has_lights = !light_tree_.nodes().empty();
    view.light_nodes = has_lights ? light_tree_.nodes().data() : nullptr;
    view.leaf_lights = has_lights ? light_tree_.leaf_lights().data() : nullptr;
    view.light_trails = has_lights ? light_tree_.trails().data() : nullptr;
    view.leaf_probabilities = has_lights ? light_tree_.leaf_probabilities().data() : nullptr;
    view.light_node_count = static_cast<std::int32_t>(light_tree_.nodes().size());
    view.leaf_light_count = static_cast<std::int32_t>(light_tree_.leaf_lights().size());
    view.instance_count = static_cast<std::int32_t>(instances_.size());
    view.key_count = static_cast<std::int32_t>(keys_.size());
    view.point_count = static_cast<std::int32_t>(points_.size());
    view.area_count = static_cast<std::int32_t>(areas_.size());
    view.air = air_;
    view.has_scattering_media = has_scattering_media_;
    return view;
}

bool RenderSpaceScene::is_large_and_near(const BoundingBox& box, const Affine<double>& map) const {
    if (box.empty()) return false;
    const double size = length(map.direction(box.high - box.low));
    const Vec3d nearest = map.point(box.nearest(map.inverse().point(origin_)));
    return size > kLarge_m && length(nearest - origin_) < kNearRatio * size;
}

Affine<double> RenderSpaceScene::object_frame(const BoundingBox& box, const Affine<double>& map) {
    Affine<double> frame;
    const double scale = std::exp2(log2_scale(map));
    frame.x.x = frame.y.y = frame.z.z = scale;
    if (!box.empty()) frame.origin = -scale * box.middle();
    return frame;
}

void RenderSpaceScene::add_object(const Scene& object, const Affine<double>& frame, LargeTriangles large) {
    objects_.push_back(std::make_unique<RenderSpaceMesh>(object, frame, large, checkpoint_));
    static_objects_.push_back(large == LargeTriangles::cut);
}

Affine<double> RenderSpaceScene::render_from_object(std::size_t i, const Affine<double>& map) const {
    if (is_static(i)) return {};
    const Affine<double>& frame = objects_[object_of_[i]]->frame();
    const double unit = 1 / frame.x.x;
    return {unit * map.x, unit * map.y, unit * map.z, map.point(-unit * frame.origin) - origin_};
}

void RenderSpaceScene::update_instances() {
    instances_.clear();
    keys_.clear();
    points_.clear();
    areas_.clear();
    area_means_.clear();
    std::vector<LightLeaf> point_leaves, area_leaves;
    add_lights(static_geometry_, {}, nullptr);
    add_leaves(0, 0, point_leaves, area_leaves);
    for (std::size_t i = 0; i < assembly_.instances.size(); ++i) {
        checkpoint_.pass();
        const std::size_t first_point = points_.size(), first_area = areas_.size();
        add_instance(i);
        add_leaves(first_point, first_area, point_leaves, area_leaves);
    }
    point_leaves.insert(point_leaves.end(), area_leaves.begin(), area_leaves.end());
    light_tree_ = LightTree(std::move(point_leaves), checkpoint_);
    set_air();
}

void RenderSpaceScene::set_air() {
    const Scene& scene = *assembly_.static_geometry;
    const Air& air = scene.air;
    air_ = {};
    if (!air.is_present()) return;
    air_ = {{air.extinction, air.extinction * air.albedo, air.anisotropy},
            {-kFarAway, -kFarAway, -kFarAway},
            {kFarAway, kFarAway, kFarAway}};
    const bool has_distant_light = !scene.suns.empty() || scene.environment.emits();
    if (!air.margin_m && !has_distant_light) return;
    BoundingBox box = static_box_;
    for (std::size_t i = 0; i < assembly_.instances.size(); ++i)
        if (!boxes_[i].empty())
            for (int corner = 0; corner < 8; ++corner)
                box.add(assembly_.instances[i].scene_from_object.point(boxes_[i].corner(corner)));
    const double margin = air.margin_m.value_or(0.5 * kKoschmieder / static_cast<double>(luminance(air.extinction)));
    const Vec3d reach = {margin, margin, margin};
    air_.low = static_cast<Vec3f>(box.low - reach - origin_);
    air_.high = static_cast<Vec3f>(box.high + reach - origin_);
}

void RenderSpaceScene::add_instance(std::size_t i) {
    const Instance& instance = assembly_.instances[i];
    const RenderSpaceMesh& object = *objects_[object_of_[i]];
    std::vector<Affine<double>> keys = {instance.scene_from_object};
    if (instance.motion) keys = exposure_keys(i);
    for (Affine<double>& key : keys) key = render_from_object(i, key);
    instances_.push_back(instance_view(keys.front(), i));
    InstanceView& view = instances_.back();
    if (keys.size() > 1) {
        view.first_key = static_cast<std::int32_t>(keys_.size());
        view.key_count = static_cast<std::int32_t>(keys.size());
        for (const Affine<double>& key : keys) {
            keys_.push_back(static_cast<Affine<float>>(key));
            widen_margins(view, key, i);
        }
    }
    add_lights(object, keys.front(), &view);
}

std::vector<Affine<double>> RenderSpaceScene::exposure_keys(std::size_t i) const {
    const Motion& motion = *assembly_.instances[i].motion;
    const BoundingBox& box = boxes_[i];
    std::vector<Vec3d> corners;
    for (int corner = 0; corner < 8; ++corner) corners.push_back(box.empty() ? Vec3d{0, 0, 0} : box.corner(corner));
    const std::optional<int> steps = key_steps(motion, exposure_, corners);
    if (!steps)
        throw InputError(label(assembly_, i) + ": turns too fast; at most about 20 rotations fit into one exposure");
    return *steps == 0 ? std::vector{motion.at(exposure_.begin_s)} : uniform_keys(motion, exposure_, *steps);
}

void RenderSpaceScene::widen_margins(InstanceView& view, const Affine<double>& key, std::size_t i) const {
    const double span = length(key.x) * length(key.y) * length(key.z);
    const auto inversion_error = static_cast<float>(1 + span / std::fabs(key.determinant()));
    const InstanceView at_key = instance_view(key, i);
    const Vec3f margin = inversion_error * at_key.margin;
    view.margin = {std::max(view.margin.x, margin.x), std::max(view.margin.y, margin.y),
                   std::max(view.margin.z, margin.z)};
    view.max_object_margin = std::max(view.max_object_margin, at_key.max_object_margin);
}

void RenderSpaceScene::add_leaves(std::size_t first_point, std::size_t first_area, std::vector<LightLeaf>& points,
                                  std::vector<LightLeaf>& areas) const {
    const std::size_t points_before = points.size(), areas_before = areas.size();
    for (std::size_t k = first_point; k < points_.size(); ++k) points.push_back(LightTree::leaf(points_[k]));
    for (std::size_t k = first_area; k < areas_.size(); ++k)
        areas.push_back(LightTree::leaf(areas_[k], area_means_[k]));
    if (instances_.empty() || instances_.back().key_count == 0) return;
    const std::int32_t keys = instances_.back().key_count;
    const SceneView scene = view();
    for (std::int32_t key = 0; key < keys; ++key) {
        const float time = static_cast<float>(key) / static_cast<float>(keys - 1);
        for (std::size_t k = first_point; k < points_.size(); ++k) {
            const LightLeaf at_key = LightTree::leaf(point_light_at(scene, points_[k], time));
            LightLeaf& leaf = points[points_before + k - first_point];
            if (key == 0)
                leaf = at_key;
            else
                LightTree::widen(leaf, at_key);
        }
        for (std::size_t k = first_area; k < areas_.size(); ++k)
            LightTree::widen(areas[areas_before + k - first_area],
                             LightTree::leaf(area_light_at(scene, areas_[k], time), area_means_[k]));
    }
}

InstanceView RenderSpaceScene::instance_view(const Affine<double>& transform, std::size_t i) const {
    const auto map = static_cast<Affine<float>>(transform);
    const InverseAffine<double> inverse = static_cast<Affine<double>>(map).inverse();
    // Error of one object coordinate for render-space coordinates of 1, from a column of the inverse.
    const auto margin_of = [](double a, double b, double c) {
        return static_cast<float>(static_cast<double>(kMarginShare) * (std::fabs(a) + std::fabs(b) + std::fabs(c)));
    };
    const Vec3f margin = {margin_of(inverse.x.x, inverse.y.x, inverse.z.x),
                          margin_of(inverse.x.y, inverse.y.y, inverse.z.y),
                          margin_of(inverse.x.z, inverse.y.z, inverse.z.z)};
    // No coordinate of the object, in a frame centred on its box, exceeds the size of the box.
    float max_object_margin = std::numeric_limits<float>::max();
    if (!is_static(i) && !boxes_[i].empty())
        max_object_margin = kMarginShare * static_cast<float>(length(transform.direction(
                                               objects_[object_of_[i]]->frame().direction(boxes_[i].size()))));
    return {map,
            static_cast<InverseAffine<float>>(inverse),
            margin,
            max_object_margin,
            object_of_[i],
            /*first_area=*/static_cast<std::int32_t>(areas_.size()),
            /*first_key=*/0,
            /*key_count=*/0};
}

void RenderSpaceScene::find_kind() {
    const auto include = [&](const Scene& scene) {
        if (!scene.colors.empty()) kind_ = std::max(kind_, SceneKind::opaque);
        for (const Material& m : scene.materials) {
            has_scattering_media_ |= m.has_scattering_interior();
            kind_ = std::max(kind_, m.has_holes()  ? SceneKind::any
                                    : m.is_plain() ? SceneKind::plain
                                                   : SceneKind::opaque);
        }
    };
    include(*assembly_.static_geometry);
    for (const Instance& instance : assembly_.instances) include(*instance.object);
    has_scattering_media_ |= assembly_.static_geometry->air.is_present();
    if (has_scattering_media_) kind_ = SceneKind::any;
}

PointLight RenderSpaceScene::point_light(const ScenePointLight& light, Vec3d position, Vec3d axis) {
    PointLight converted{static_cast<Vec3f>(position), light.intensity};
    if (!(length(axis) > 0)) return converted;
    converted.axis = static_cast<Vec3f>(normalized(axis));
    // Lower bound of KHR_lights_punctual: a spot with equal inner and outer angles would have an infinite slope.
    const double cos_outer = std::cos(light.outer_cone_rad);
    const double scale = 1 / std::max(1e-3, std::cos(light.inner_cone_rad) - cos_outer);
    converted.cos_scale = static_cast<float>(scale);
    converted.cos_offset = static_cast<float>(-cos_outer * scale);
    return converted;
}

void RenderSpaceScene::add_lights(const RenderSpaceMesh& mesh, const Affine<double>& map,
                                  const InstanceView* instance) {
    const Scene& scene = mesh.scene();
    const std::uint32_t instance_index = instance ? static_cast<std::uint32_t>(instances_.size() - 1) : kNoInstance;
    const bool moves = instance && instance->key_count > 0;
    for (const ScenePointLight& p : scene.points) {
        const Vec3d position = mesh.frame().point(p.position_m), axis = mesh.frame().direction(p.axis);
        points_.push_back(moves ? point_light(p, position, axis)
                                : point_light(p, map.point(position), map.direction(axis)));
        if (moves) points_.back().moves_with = static_cast<std::int32_t>(instance_index);
    }
    const InverseAffine<double> inverse = map.inverse();
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
        areas_.push_back({corner, static_cast<Vec3f>(u), static_cast<Vec3f>(v), static_cast<Vec3f>(normalized(normal)),
                          scene.materials[t.material].emits_on_both_sides, scene.materials[t.material].emission,
                          static_cast<float>(0.5 * length(cross(u, v))), margin, emitter, instance_index});
    }
}

}  // namespace realcam
