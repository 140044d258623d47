#pragma once
#include <algorithm>
#include <limits>
#include <unordered_map>

#include "../assembly.hpp"

namespace REALCAM_NAMESPACE {

struct BoundingBox {
    static constexpr double kNone = std::numeric_limits<double>::infinity();
    Vec3d low = {kNone, kNone, kNone}, high = {-kNone, -kNone, -kNone};

    Vec3d middle() const { return 0.5 * (low + high); }
    bool empty() const { return !(low.x <= high.x); }
    Vec3d size() const { return high - low; }
    double diagonal() const { return empty() ? 0.0 : length(size()); }
    /// One of the eight corners: bits 0, 1, 2 choose the high end of x, y, z.
    Vec3d corner(int bits) const {
        return {bits & 1 ? high.x : low.x, bits & 2 ? high.y : low.y, bits & 4 ? high.z : low.z};
    }

    void add(Vec3d p);
    void add(const BoundingBox& other);
    Vec3d nearest(Vec3d p) const {
        return {std::clamp(p.x, low.x, high.x), std::clamp(p.y, low.y, high.y), std::clamp(p.z, low.z, high.z)};
    }
};

/// Adds the triangles of a scene (metres), transformed by `map`.
void add_triangles(BoundingBox& box, const Scene& scene, const Affine<double>& map);

/// Bounding boxes of objects in object space, each computed once however many instances the object has.
class ObjectBoxes {
public:
    const BoundingBox& of(const Scene& object);
    /// In scene space: the box of the eight transformed corners of the object's box, which may be larger than its
    /// triangles require.
    BoundingBox of(const Instance& instance);

private:
    std::unordered_map<const Scene*, BoundingBox> boxes_;
};

/// Up to this many instanced triangles bounding boxes are exact; beyond, the transformed box of an object is used.
inline constexpr std::size_t kMostTrianglesTested = std::size_t{1} << 22;

inline bool asks_every_triangle(const Assembly& assembly) {
    return assembly.triangle_count() - assembly.static_geometry->triangles.size() <= kMostTrianglesTested;
}

/// Bounding box of a scene in metres. Above kMostTrianglesTested instanced triangles it encloses the transformed boxes
/// of the objects, which are not tight for rotated instances.
BoundingBox bounding_box(const Assembly& assembly);

}  // namespace REALCAM_NAMESPACE
