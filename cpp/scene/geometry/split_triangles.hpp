#pragma once
#include <algorithm>
#include <array>
#include <vector>

#include "../../checkpoint.hpp"
#include "../../math/affine.hpp"
#include "../scene.hpp"

namespace REALCAM_NAMESPACE {

// If a triangle is much larger than its distance from the camera, the rounding of its float corners exceeds the size of
// objects that stand on it: a plane of 1e7 m would be half a metre off below the camera. Such triangles are split into
// pieces about as large as their distance, whose corners are accurate enough.

/// Treatment of triangles that are much larger than their distance: split them (cut), or leave them as they are (keep).
enum class LargeTriangles { cut, keep };

/// Translation into a frame whose origin is `origin_m`.
Affine<double> relative_to(Vec3d origin_m);

/// Triangles of a scene in another frame, with those that are large relative to their distance from its origin split:
/// the first piece replaces the triangle, the others are appended. Normals stay in the scene's frame.
class SplitTriangles {
public:
    /// `frame`: transform from scene space, in which distances are measured from the origin. The scene must outlive
    /// this object. Throws Cancelled if `checkpoint` does.
    SplitTriangles(const Scene& scene, const Affine<double>& frame, LargeTriangles large, Checkpoint& checkpoint);

    /// True if any triangle was split; otherwise the lists are the scene's own.
    bool any() const { return !triangles_.empty(); }
    const std::vector<Triangle>& triangles() const { return any() ? triangles_ : scene_.triangles; }
    const std::vector<Vec3f>& normals() const { return any() ? normals_ : scene_.normals; }
    const std::vector<Vec2f>& uvs() const { return any() ? uvs_ : scene_.uvs; }
    const std::vector<Vec2f>& second_uvs() const { return any() ? second_uvs_ : scene_.second_uvs; }
    const std::vector<VertexColor>& colors() const { return any() ? colors_ : scene_.colors; }

    std::size_t position_count() const { return scene_.positions_m.size() + added_positions_.size(); }
    /// Position of a vertex in the new frame.
    Vec3d position(std::size_t vertex) const;
    /// Index of the scene's triangle from which a triangle was split; the same index if it was not split.
    std::size_t parent(std::size_t triangle) const;

private:
    /// Largest ratio of an edge's length to its distance: roundings to 24 bits are then 1e-5 of the distance, a small
    /// fraction of a pixel. A smaller ratio would make more large pieces, and a large piece among small triangles slows
    /// down all rays.
    static constexpr double kRatio = 128;
    /// Least distance of scene geometry, in metres: closer points would be inside the lens.
    static constexpr double kMinDistance_m = 0.01;
    /// Limit of the recursion depth, beyond what the range of coordinates can require.
    static constexpr int kMaxDepth = 200;

    /// Squared length of the longest edge.
    static double longest_squared(Vec3d a, Vec3d b, Vec3d c) {
        return std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)});
    }

    /// Quick rejection by the corners: false if the nearest corner is farther away than 1 + 1 / kRatio edge lengths.
    bool may_be_too_large(const Triangle& t) const;

    /// True if an edge is longer than kRatio times its distance. Independent of the order of the two ends: neighbours
    /// split their common edge in the same way, and no crack opens.
    static bool too_long(Vec3d p, Vec3d q);

    /// Barycentric coordinates of the origin's projection onto the plane of a triangle; some are negative if it lies
    /// outside the triangle.
    static std::array<double, 3> projected_origin(Vec3d a, Vec3d b, Vec3d c);

    /// Splits edges that are too long, the longest first; then, if the origin is above the interior, splits at its
    /// projection. `depth_left`: levels of recursion that remain.
    void split(const Triangle& t, int depth_left);

    /// Splits at the midpoint of the edge that starts at this corner.
    void halve(const Triangle& t, int corner, int depth_left);

    /// Adds a vertex at these barycentric coordinates of a triangle and returns its index.
    std::uint32_t add_vertex(const Triangle& t, std::array<double, 3> weights);

    /// Stores a triangle that is split no further.
    void add_piece(const Triangle& t);

    /// Copies the scene's lists before the first change.
    void copy_lists();

    const Scene& scene_;
    Affine<double> frame_;
    std::vector<Vec3d> added_positions_;
    std::vector<Triangle> triangles_;
    std::vector<Vec3f> normals_;
    std::vector<Vec2f> uvs_, second_uvs_;
    std::vector<VertexColor> colors_;
    std::vector<std::uint32_t> parents_;  ///< for each appended triangle
    std::uint32_t parent_ = 0;  ///< triangle that is being split
    bool is_first_piece_ = true;  ///< no piece of it has been stored yet
};

}  // namespace REALCAM_NAMESPACE
