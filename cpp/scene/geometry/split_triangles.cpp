#include "split_triangles.hpp"

#include <cmath>
#include <utility>

namespace realcam {

Affine<double> relative_to(Vec3d origin_m) {
    Affine<double> frame;
    frame.origin = -origin_m;
    return frame;
}

SplitTriangles::SplitTriangles(const Scene& scene, const Affine<double>& frame, LargeTriangles large,
                               Checkpoint& checkpoint)
    : scene_(scene), frame_(frame) {
    if (large == LargeTriangles::keep) return;
    const auto count = static_cast<std::uint32_t>(scene.triangles.size());
    for (std::uint32_t i = 0; i < count; ++i) {
        checkpoint.pass();
        const Triangle t = scene.triangles[i];
        if (!may_be_too_large(t)) continue;
        parent_ = i;
        is_first_piece_ = true;
        split(t, kMaxDepth);
    }
}

Vec3d SplitTriangles::position(std::size_t vertex) const {
    const std::size_t in_scene = scene_.positions_m.size();
    return vertex < in_scene ? frame_.point(scene_.positions_m[vertex]) : added_positions_[vertex - in_scene];
}

std::size_t SplitTriangles::parent(std::size_t triangle) const {
    const std::size_t in_scene = scene_.triangles.size();
    return triangle < in_scene ? triangle : parents_[triangle - in_scene];
}

bool SplitTriangles::may_be_too_large(const Triangle& t) const {
    constexpr double kFarSquared = (1 + 1 / kRatio) * (1 + 1 / kRatio);
    const Vec3d a = position(t.vertices[0]), b = position(t.vertices[1]), c = position(t.vertices[2]);
    const double longest = longest_squared(a, b, c);
    return std::min({dot(a, a), dot(b, b), dot(c, c)}) < kFarSquared * longest &&
           longest > kRatio * kRatio * kMinDistance_m * kMinDistance_m;
}

bool SplitTriangles::too_long(Vec3d p, Vec3d q) {
    if (q.x < p.x || (q.x == p.x && (q.y < p.y || (q.y == p.y && q.z < p.z)))) std::swap(p, q);
    const Vec3d d = q - p;
    const double squared = dot(d, d);
    // p + t d is the point of the edge that is nearest to the origin.
    const double t = squared > 0 ? std::clamp(-dot(p, d) / squared, 0.0, 1.0) : 0.0;
    return std::sqrt(squared) > kRatio * std::max(length(p + t * d), kMinDistance_m);
}

std::array<double, 3> SplitTriangles::projected_origin(Vec3d a, Vec3d b, Vec3d c) {
    const Vec3d u = b - a, v = c - a;
    const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), ua = -dot(u, a), va = -dot(v, a);
    const double determinant = uu * vv - uv * uv;
    const double s = (vv * ua - uv * va) / determinant, t = (uu * va - uv * ua) / determinant;
    return {1 - s - t, s, t};
}

void SplitTriangles::split(const Triangle& t, int depth_left) {
    const std::array<Vec3d, 3> p{position(t.vertices[0]), position(t.vertices[1]), position(t.vertices[2])};
    int longest = -1;  // first corner of the longest edge among those that are too long
    double length_squared = 0;
    for (int i = 0; i < 3; ++i) {
        const Vec3d from = p[static_cast<std::size_t>(i)], to = p[static_cast<std::size_t>((i + 1) % 3)];
        const double squared = dot(to - from, to - from);
        if (squared > length_squared && too_long(from, to)) {
            longest = i;
            length_squared = squared;
        }
    }
    if (depth_left == 0) return add_piece(t);
    if (longest >= 0) return halve(t, longest, depth_left);
    const std::array<double, 3> w = projected_origin(p[0], p[1], p[2]);
    constexpr double kMinWeight = 1e-6;  // closer to an edge, pieces would be degenerate
    if (!(w[0] > kMinWeight && w[1] > kMinWeight && w[2] > kMinWeight)) return add_piece(t);
    const double distance = std::max(length(w[0] * p[0] + w[1] * p[1] + w[2] * p[2]), kMinDistance_m);
    if (!(longest_squared(p[0], p[1], p[2]) > kRatio * kRatio * distance * distance)) return add_piece(t);
    const std::uint32_t middle = add_vertex(t, w);
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
        Triangle part = t;
        part.vertices[corner] = middle;
        split(part, depth_left - 1);
    }
}

void SplitTriangles::halve(const Triangle& t, int corner, int depth_left) {
    std::array<double, 3> weights{0.5, 0.5, 0.5};
    weights[static_cast<std::size_t>((corner + 2) % 3)] = 0;
    const std::uint32_t middle = add_vertex(t, weights);
    Triangle first = t, second = t;
    first.vertices[(corner + 1) % 3] = middle;
    second.vertices[corner] = middle;
    split(first, depth_left - 1);
    split(second, depth_left - 1);
}

std::uint32_t SplitTriangles::add_vertex(const Triangle& t, std::array<double, 3> weights) {
    copy_lists();
    const std::uint32_t* v = t.vertices;
    const std::array<float, 3> w{static_cast<float>(weights[0]), static_cast<float>(weights[1]),
                                 static_cast<float>(weights[2])};
    // Left unnormalised, so that interpolation equals that over the original triangle.
    if (!normals_.empty()) normals_.push_back(w[0] * normals_[v[0]] + w[1] * normals_[v[1]] + w[2] * normals_[v[2]]);
    for (std::vector<Vec2f>* uvs : {&uvs_, &second_uvs_}) {
        if (uvs->empty()) continue;
        const Vec2f a = (*uvs)[v[0]], b = (*uvs)[v[1]], c = (*uvs)[v[2]];
        uvs->push_back({w[0] * a.x + w[1] * b.x + w[2] * c.x, w[0] * a.y + w[1] * b.y + w[2] * c.y});
    }
    if (!colors_.empty()) {
        const VertexColor &a = colors_[v[0]], &b = colors_[v[1]], &c = colors_[v[2]];
        colors_.push_back(
            {w[0] * a.color + w[1] * b.color + w[2] * c.color, w[0] * a.alpha + w[1] * b.alpha + w[2] * c.alpha});
    }
    added_positions_.push_back(weights[0] * position(v[0]) + weights[1] * position(v[1]) + weights[2] * position(v[2]));
    return static_cast<std::uint32_t>(position_count() - 1);
}

void SplitTriangles::add_piece(const Triangle& t) {
    if (!any()) return;
    if (is_first_piece_) {
        triangles_[parent_] = t;
    } else {
        triangles_.push_back(t);
        parents_.push_back(parent_);
    }
    is_first_piece_ = false;
}

void SplitTriangles::copy_lists() {
    if (any()) return;
    triangles_ = scene_.triangles;
    normals_ = scene_.normals;
    uvs_ = scene_.uvs;
    second_uvs_ = scene_.second_uvs;
    colors_ = scene_.colors;
}

}  // namespace realcam
