#pragma once
#include <algorithm>
#include <limits>
#include <unordered_map>

#include "assembly.hpp"

namespace REALCAM_NAMESPACE {

struct BoundingBox {
    static constexpr double kNone = std::numeric_limits<double>::infinity();
    Vec3d low = {kNone, kNone, kNone}, high = {-kNone, -kNone, -kNone};

    Vec3d middle() const { return 0.5 * (low + high); }
    bool empty() const { return !(low.x <= high.x); }
    Vec3d size() const { return high - low; }
    double diagonal() const { return empty() ? 0.0 : length(size()); }
    /// One of the eight, by three bits.
    Vec3d corner(int bits) const {
        return {bits & 1 ? high.x : low.x, bits & 2 ? high.y : low.y, bits & 4 ? high.z : low.z};
    }

    void add(Vec3d p);
    void add(const BoundingBox& other);
    Vec3d nearest(Vec3d p) const {
        return {std::clamp(p.x, low.x, high.x), std::clamp(p.y, low.y, high.y), std::clamp(p.z, low.z, high.z)};
    }
};

/// Adds the triangles of a scene, metres, as a map transforms them.
void add_triangles(BoundingBox& box, const Scene& scene, const Affine<double>& map);

/// Boxes of objects in their own coordinates, each made once, however many instances an object has.
class ObjectBoxes {
public:
    const BoundingBox& of(const Scene& object);
    /// In the scene's coordinates: of the eight corners of the object's box, which may reach past its triangles.
    BoundingBox of(const Instance& instance);

private:
    std::unordered_map<const Scene*, BoundingBox> boxes_;
};

/// Up to here each triangle of each instance is asked by itself; beyond, the box of an object stands for it.
inline constexpr std::size_t kMostTrianglesAsked = std::size_t{1} << 22;

inline bool asks_every_triangle(const Assembly& assembly) {
    return assembly.triangle_count() - assembly.static_geometry->triangles.size() <= kMostTrianglesAsked;
}

/// The box of a scene, metres. For instances with many triangles in all (kMostTrianglesAsked) it holds the boxes of
/// their objects, and is larger where these are turned.
BoundingBox bounding_box(const Assembly& assembly);

}  // namespace REALCAM_NAMESPACE
