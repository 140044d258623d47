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

enum class LargeTriangles { cut, keep };

/// Translation into a frame whose origin is `origin_m`.
Affine<double> relative_to(Vec3d origin_m);

/// Triangles of a scene in another frame, with those that are large relative to their distance from its origin split:
/// the first piece replaces the triangle, the others are appended. Normals stay in the scene's frame.
class SplitTriangles {
public:
    SplitTriangles(const Scene& scene, const Affine<double>& frame, LargeTriangles large, Checkpoint& checkpoint);

    /// True if any triangle was split; otherwise the lists are the scene's own.
    bool any() const { return !triangles_.empty(); }
    const std::vector<Triangle>& triangles() const { return any() ? triangles_ : scene_.triangles; }
    const std::vector<Vec3f>& normals() const { return any() ? normals_ : scene_.normals; }
    const std::vector<Vec2f>& uvs() const { return any() ? uvs_ : scene_.uvs; }
    const std::vector<Vec2f>& second_uvs() const { return any() ? second_uvs_ : scene_.second_uvs; }
    const std::vector<VertexColor>& colors() const { return any() ? colors_ : scene_.colors; }

    std::size_t position_count() const { return scene_.positions_m.size() + added_.size(); }
    /// Position in the new frame.
    Vec3d position(std::size_t vertex) const;
    /// Index of the scene's triangle from which a triangle was split.
    std::size_t parent(std::size_t triangle) const;

private:
    /// Largest ratio of an edge's length to its distance: roundings to 24 bits are then 1e-5 of the distance, a small
    /// fraction of a pixel. A smaller ratio would make more large pieces, and a large piece among small triangles slows
    /// down all rays.
    static constexpr double kRatio = 128;
    /// Least distance of scene geometry, in metres: closer points would be inside the lens.
    static constexpr double kNearest = 0.01;
    /// Limit of the recursion depth, beyond what the range of coordinates can require.
    static constexpr int kMostCuts = 200;

    static double longest_squared(Vec3d a, Vec3d b, Vec3d c) {
        return std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)});
    }

    /// Quick rejection by the corners: false if the nearest corner is farther away than 1 + 1 / kRatio edge lengths.
    bool may_be_too_large(const Triangle& t) const;

    /// Independent of the order of the two ends: neighbours split their common edge in the same way, and no crack
    /// opens.
    static bool too_long(Vec3d p, Vec3d q);

    /// Barycentric coordinates of the origin's projection onto the plane; negative ones if it lies outside the
    /// triangle.
    static std::array<double, 3> foot(Vec3d a, Vec3d b, Vec3d c);

    /// Splits edges that are too long, the longest first; then, if the origin is above the interior, splits at its
    /// projection.
    void split(const Triangle& t, int cuts_left);

    /// Splits at the midpoint of the edge that starts at this corner.
    void halve(const Triangle& t, int corner, int cuts_left);

    std::uint32_t add_vertex(const Triangle& t, std::array<double, 3> weights);

    void keep(const Triangle& t);

    void copy_lists();

    const Scene& scene_;
    Affine<double> frame_;
    std::vector<Vec3d> added_;
    std::vector<Triangle> triangles_;
    std::vector<Vec3f> normals_;
    std::vector<Vec2f> uvs_, second_uvs_;
    std::vector<VertexColor> colors_;
    std::vector<std::uint32_t> parents_;
    std::uint32_t parent_ = 0;
    bool first_piece_ = true;
};

}  // namespace REALCAM_NAMESPACE
