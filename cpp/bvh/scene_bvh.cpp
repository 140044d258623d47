#include "scene_bvh.hpp"

#include <cmath>
#include <limits>

#include "../scene/surface_point.hpp"

namespace realcam {
namespace {

Box box_of(const PlacedMesh& mesh) {
    if (mesh.triangles().empty()) return {{0, 0, 0}, {0, 0, 0}};
    const Vec3f start = mesh.positions()[mesh.triangles()[0].vertices[0]];
    Box box = {start, start};
    for (const Triangle& t : mesh.triangles())
        for (const std::uint32_t v : t.vertices) grow(box, {mesh.positions()[v], mesh.positions()[v]});
    return box;
}

/// Of a box's corners where an instance puts them. The ray is taken into the object's frame by some roundings of the
/// coordinates; what it meets on the very surface of the box is not to be lost by them.
Box placed_box(const Box& box, const InstanceView& instance) {
    constexpr float kRoundings = 0x1p-20f, kInfinity = std::numeric_limits<float>::infinity();
    Box placed = {{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
    for (unsigned corner = 0; corner < 8; ++corner) {
        const Vec3f p = instance.placed_from_object.point({corner & 1u ? box.upper.x : box.lower.x,
                                                           corner & 2u ? box.upper.y : box.lower.y,
                                                           corner & 4u ? box.upper.z : box.lower.z});
        grow(placed, {p, p});
    }
    const float margin = kRoundings * (largest_coordinate(placed.lower) + largest_coordinate(placed.upper) +
                                       largest_coordinate(instance.placed_from_object.origin));
    const Vec3f all_sides = {margin, margin, margin};
    return {placed.lower - all_sides, placed.upper + all_sides};
}

}  // namespace

SceneBvh build_scene_bvh(const PlacedScene& scene) {
    SceneBvh bvh;
    bvh.ground = build_wide_bvh(scene.ground().positions(), scene.ground().triangles());
    for (const auto& object : scene.objects()) {
        bvh.objects.push_back(build_wide_bvh(object->positions(), object->triangles()));
        bvh.object_boxes.push_back(box_of(*object));
    }
    const auto& instances = scene.instances();
    bvh.instances = build_wide_nodes(instances.size(), [&](std::uint32_t i) {
        return placed_box(bvh.object_boxes[instances[i].object], instances[i]);
    });
    return bvh;
}

void refit_instances(SceneBvh& bvh, const PlacedScene& scene) {
    refit(bvh.instances.nodes, [&](std::uint32_t leaf) {
        const InstanceView& instance = scene.instances()[bvh.instances.order[leaf]];
        return placed_box(bvh.object_boxes[instance.object], instance);
    });
}

std::vector<BvhInstance> bvh_instances(const SceneBvh& bvh, const PlacedScene& scene,
                                       const std::vector<WideBvhView>& objects) {
    std::vector<BvhInstance> leaves;
    for (const std::uint32_t index : bvh.instances.order) {
        const InstanceView& instance = scene.instances()[index];
        leaves.push_back({instance.object_from_placed, objects[instance.object], index});
    }
    return leaves;
}

}  // namespace realcam
