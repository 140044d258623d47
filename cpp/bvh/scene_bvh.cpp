#include "scene_bvh.hpp"

#include <bit>
#include <cmath>
#include <limits>

#include "../scene/geometry/surface_point.hpp"

namespace realcam {
namespace {

Box box_of(const RenderSpaceMesh& mesh) {
    if (mesh.triangles().empty()) return {{0, 0, 0}, {0, 0, 0}};
    const Vec3f start = mesh.positions()[mesh.triangles()[0].vertices[0]];
    Box box = {start, start};
    for (const Triangle& t : mesh.triangles())
        for (const std::uint32_t v : t.vertices) grow(box, {mesh.positions()[v], mesh.positions()[v]});
    return box;
}

/// Returns the bounding box, in render space, of an object's box transformed by an instance. It is widened, because
/// transforming a ray into the object's frame rounds its coordinates: hits on the surface of the box must not be lost.
Box transformed_box(const Box& box, const Affine<float>& render_from_object) {
    constexpr float kRelativeMargin = 0x1p-20f, kInfinity = std::numeric_limits<float>::infinity();
    Box result = {{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
    for (unsigned corner = 0; corner < 8; ++corner) {
        const Vec3f p =
            render_from_object.point({corner & 1u ? box.upper.x : box.lower.x, corner & 2u ? box.upper.y : box.lower.y,
                                      corner & 4u ? box.upper.z : box.lower.z});
        grow(result, {p, p});
    }
    const float margin = kRelativeMargin * (largest_coordinate(result.lower) + largest_coordinate(result.upper) +
                                            largest_coordinate(render_from_object.origin));
    const Vec3f all_sides = {margin, margin, margin};
    return {result.lower - all_sides, result.upper + all_sides};
}

/// Bounding box of an instance in render space, over all its positions while the shutter is open.
Box instance_box(const SceneBvh& bvh, const RenderSpaceScene& scene, std::uint32_t index) {
    const InstanceView& instance = scene.instances()[index];
    const Box& own = bvh.object_boxes[instance.object];
    Box box = transformed_box(own, instance.render_from_object);
    // Between two keys every point moves along a line, which stays within the bounding box of both ends.
    for (std::int32_t k = 0; k < instance.key_count; ++k)
        grow(box, transformed_box(own, scene.keys()[static_cast<std::size_t>(instance.first_key + k)]));
    return box;
}

void build_instances(SceneBvh& bvh, const RenderSpaceScene& scene) {
    bvh.instances =
        build_wide_nodes(scene.instances().size(), [&](std::uint32_t i) { return instance_box(bvh, scene, i); });
    bvh.built_cost = expected_nodes(bvh.instances.nodes);
}

}  // namespace

double expected_nodes(const std::vector<WideNode>& nodes) {
    const auto half_area_of = [](const WideNode& node) {
        const auto extent = [](std::uint32_t step_bits) {
            return 255 * static_cast<double>(std::bit_cast<float>(step_bits & 0xffff0000u));
        };
        const double x = extent(node.steps_xy), y = extent(node.steps_xy << 16), z = extent(node.step_z_reach);
        return x * y + y * z + z * x;
    };
    double sum = 0;
    for (const WideNode& node : nodes) sum += half_area_of(node);
    const double root = half_area_of(nodes.front());
    return root > 0 ? sum / root : static_cast<double>(nodes.size());
}

SceneBvh build_scene_bvh(const RenderSpaceScene& scene, const KeepGoing& keep_going) {
    SceneBvh bvh;
    bvh.static_geometry =
        build_wide_bvh(scene.static_geometry().positions(), scene.static_geometry().triangles(), keep_going);
    for (const auto& object : scene.objects()) {
        bvh.objects.push_back(build_wide_bvh(object->positions(), object->triangles(), keep_going));
        bvh.object_boxes.push_back(box_of(*object));
    }
    build_instances(bvh, scene);
    return bvh;
}

void refit_instances(SceneBvh& bvh, const RenderSpaceScene& scene) {
    refit(bvh.instances.nodes, [&](std::uint32_t leaf) { return instance_box(bvh, scene, bvh.instances.order[leaf]); });
    constexpr double kMaxCostRatio = 2;
    if (expected_nodes(bvh.instances.nodes) > kMaxCostRatio * bvh.built_cost) build_instances(bvh, scene);
}

std::vector<BvhInstance> bvh_instances(const SceneBvh& bvh, const RenderSpaceScene& scene,
                                       const std::vector<WideBvhView>& objects) {
    std::vector<BvhInstance> leaves;
    for (const std::uint32_t index : bvh.instances.order) {
        const InstanceView& instance = scene.instances()[index];
        leaves.push_back({instance.object_from_render, objects[instance.object], index, instance.key_count > 0});
    }
    return leaves;
}

}  // namespace realcam
