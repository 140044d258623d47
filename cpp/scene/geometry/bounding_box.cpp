#include "bounding_box.hpp"

#include "../assembly.hpp"

namespace realcam {

void BoundingBox::add(Vec3d p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
}

void BoundingBox::add(const BoundingBox& other) {
    if (other.empty()) return;
    add(other.low);
    add(other.high);
}

void add_triangles(BoundingBox& box, const Scene& scene, const Affine<double>& map) {
    for (const Triangle& t : scene.triangles)
        for (const std::uint32_t vertex : t.vertices) box.add(map.point(scene.positions_m[vertex]));
}

const BoundingBox& ObjectBoxes::of(const Scene& object) {
    const auto [entry, is_new] = boxes_.try_emplace(&object);
    if (is_new) add_triangles(entry->second, object, {});
    return entry->second;
}

BoundingBox ObjectBoxes::of(const Instance& instance) {
    BoundingBox box;
    const BoundingBox& object_box = of(*instance.object);
    for (int corner = 0; corner < 8 && !object_box.empty(); ++corner)
        box.add(instance.scene_from_object.point(object_box.corner(corner)));
    return box;
}

BoundingBox bounding_box(const Assembly& assembly) {
    BoundingBox box;
    add_triangles(box, *assembly.static_geometry, {});
    ObjectBoxes objects;
    const bool is_exact = has_exact_boxes(assembly);
    for (const Instance& instance : assembly.instances) {
        if (is_exact)
            add_triangles(box, *instance.object, instance.scene_from_object);
        else
            box.add(objects.of(instance));
    }
    return box;
}

}  // namespace realcam
