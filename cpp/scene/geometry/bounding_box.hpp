#pragma once
#include <algorithm>
#include <limits>
#include <unordered_map>

#include "../assembly.hpp"

namespace REALCAM_NAMESPACE {

/// Axis-aligned bounding box; initially empty.
struct BoundingBox {
    /// Magnitude of the ends of an empty box.
    static constexpr double kNone = std::numeric_limits<double>::infinity();
    Vec3d low = {kNone, kNone, kNone}, high = {-kNone, -kNone, -kNone};

    /// Centre of the box, which must not be empty.
    Vec3d middle() const { return 0.5 * (low + high); }
    bool empty() const { return !(low.x <= high.x); }
    Vec3d size() const { return high - low; }
    /// Length of the space diagonal; 0 if the box is empty.
    double diagonal() const { return empty() ? 0.0 : length(size()); }
    /// One of the eight corners: bits 0, 1, 2 choose the high end of x, y, z.
    Vec3d corner(int bits) const {
        return {bits & 1 ? high.x : low.x, bits & 2 ? high.y : low.y, bits & 4 ? high.z : low.z};
    }

    /// Extends the box to enclose a point.
    void add(Vec3d p);
    /// Extends the box to enclose another one.
    void add(const BoundingBox& other);
    /// Returns the point of the box that is nearest to p.
    Vec3d nearest(Vec3d p) const {
        return {std::clamp(p.x, low.x, high.x), std::clamp(p.y, low.y, high.y), std::clamp(p.z, low.z, high.z)};
    }
};

/// Extends the box to enclose the triangles of a scene (metres), transformed by `map`.
void add_triangles(BoundingBox& box, const Scene& scene, const Affine<double>& map);

/// Bounding boxes of objects in object space, each computed once however many instances the object has.
class ObjectBoxes {
public:
    /// Returns the bounding box of an object, in object space.
    const BoundingBox& of(const Scene& object);
    /// Returns the bounding box, in scene space, of the eight transformed corners of the object's box. It may be larger
    /// than the triangles require.
    BoundingBox of(const Instance& instance);

private:
    std::unordered_map<const Scene*, BoundingBox> boxes_;
};

/// Up to this many instanced triangles bounding boxes are exact; beyond, the transformed box of an object is used.
inline constexpr std::size_t kMaxTrianglesTested = std::size_t{1} << 22;

/// True if bounding boxes of the scene's instances are computed from every triangle (kMaxTrianglesTested).
inline bool has_exact_boxes(const Assembly& assembly) {
    return assembly.triangle_count() - assembly.static_geometry->triangles.size() <= kMaxTrianglesTested;
}

/// Bounding box of a scene in metres. Above kMaxTrianglesTested instanced triangles it encloses the transformed boxes
/// of the objects, which are not tight for rotated instances.
BoundingBox bounding_box(const Assembly& assembly);

}  // namespace REALCAM_NAMESPACE
