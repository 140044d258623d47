#pragma once
#include <algorithm>
#include <limits>

#include "assembly.hpp"

namespace REALCAM_NAMESPACE {

struct BoundingBox {
    static constexpr double kNone = std::numeric_limits<double>::infinity();
    Vec3d low = {kNone, kNone, kNone}, high = {-kNone, -kNone, -kNone};

    Vec3d middle() const { return 0.5 * (low + high); }
    bool empty() const { return !(low.x <= high.x); }

    void add(Vec3d p) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    Vec3d nearest(Vec3d p) const {
        return {std::clamp(p.x, low.x, high.x), std::clamp(p.y, low.y, high.y), std::clamp(p.z, low.z, high.z)};
    }
};

/// Of the triangles of a scene, metres, as a map takes them.
inline void add_triangles(BoundingBox& box, const Scene& scene, const Affine<double>& map) {
    for (const Triangle& t : scene.triangles)
        for (const std::uint32_t vertex : t.vertices) box.add(map.point(scene.positions_m[vertex]));
}

inline BoundingBox bounding_box(const Assembly& assembly) {
    BoundingBox box;
    add_triangles(box, *assembly.static_geometry, {});
    for (const Instance& instance : assembly.instances)
        add_triangles(box, *instance.object, instance.scene_from_object);
    return box;
}

}  // namespace REALCAM_NAMESPACE
