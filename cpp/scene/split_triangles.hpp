#pragma once
#include <algorithm>
#include <array>
#include <vector>

#include "../checkpoint.hpp"
#include "../math/affine.hpp"
#include "scene.hpp"

namespace REALCAM_NAMESPACE {

// If a triangle is much larger than its distance from the camera, the rounding of its float corners is larger than what
// stands on it. A plain of 1e7 m would be half a metre off under the camera's feet. It is cut into pieces, each of
// about the size of its own distance, whose corners are as exact as they need to be.

enum class LargeTriangles { cut, keep };

/// Into a frame that is only shifted.
Affine<double> relative_to(Vec3d origin_m);

/// The triangles of a scene in another frame, those that are large about its origin in pieces: the first piece takes
/// the place of the triangle, the others are appended. Normals are those of the scene's own frame.
class SplitTriangles {
public:
    SplitTriangles(const Scene& scene, const Affine<double>& frame, LargeTriangles large, Checkpoint& checkpoint);

    /// Whether any triangle was cut. If not, the lists are the scene's own.
    bool any() const { return !triangles_.empty(); }
    const std::vector<Triangle>& triangles() const { return any() ? triangles_ : scene_.triangles; }
    const std::vector<Vec3f>& normals() const { return any() ? normals_ : scene_.normals; }
    const std::vector<Vec2f>& uvs() const { return any() ? uvs_ : scene_.uvs; }
    const std::vector<Vec2f>& second_uvs() const { return any() ? second_uvs_ : scene_.second_uvs; }
    const std::vector<VertexColor>& colors() const { return any() ? colors_ : scene_.colors; }

    std::size_t position_count() const { return scene_.positions_m.size() + added_.size(); }
    /// In the frame.
    Vec3d position(std::size_t vertex) const;
    /// The scene's triangle of which this one is a piece.
    std::size_t parent(std::size_t triangle) const;

private:
    /// An edge may be so many times as long as its distance: roundings to 24 bits are then 1e-5 of the distance, a
    /// small part of a pixel. Every large piece among small triangles slows all rays down, so that it is not less.
    static constexpr double kRatio = 128;
    /// Nothing is nearer than this: inside the lens there is no scene. Metres.
    static constexpr double kNearest = 0.01;
    /// More cuts in a row than the range of coordinates can ask for; ends the recursion whatever the roundings do.
    static constexpr int kMostCuts = 200;

    static double longest_squared(Vec3d a, Vec3d b, Vec3d c) {
        return std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)});
    }

    /// Most triangles are ruled out by their corners: the nearest lies farther away than 1 + 1 / kRatio edges.
    bool may_be_too_large(const Triangle& t) const;

    /// Depends on the two ends alone and not on their order: neighbours cut their common edge alike, and no gap opens.
    static bool too_long(Vec3d p, Vec3d q);

    /// Barycentric coordinates of the origin's foot on the plane; some are negative where it lies outside.
    static std::array<double, 3> foot(Vec3d a, Vec3d b, Vec3d c);

    /// Edges first, from the longest on; then, where the origin lies above the middle, the part below it.
    void split(const Triangle& t, int cuts_left);

    /// Across the middle of the edge that begins at this corner.
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
