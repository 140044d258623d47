#include "scene_normals.hpp"

#include <cmath>
#include <numeric>

#include "vertex_welding.hpp"

namespace realcam::io {
namespace {

constexpr double cos_crease = 0.70710678118654752;

// The work grows with the square of the faces at one vertex. The hub of so wide a fan is flat enough.
constexpr std::size_t most_faces = 512;

double angle_between(Vec3d a, Vec3d b) {
    return std::atan2(length(cross(a, b)), dot(a, b));
}

}  // namespace

void smooth_normals(Scene& scene, const std::vector<std::uint32_t>& triangles) {
    const std::size_t face_count = triangles.size(), corner_count = 3 * face_count;
    if (scene.normals.empty()) scene.normals.assign(scene.positions_m.size(), Vec3f{0, 0, 0});

    const auto position = [&](std::size_t corner) {
        return scene.positions_m[scene.triangles[triangles[corner / 3]].vertices[corner % 3]];
    };
    std::vector<Vec3d> face_normals(face_count);
    std::vector<double> angles(corner_count);
    for (std::size_t f = 0; f < face_count; ++f) {
        const Vec3d a = position(3 * f), b = position(3 * f + 1), c = position(3 * f + 2);
        face_normals[f] = normalized(cross(b - a, c - a));
        angles[3 * f] = angle_between(b - a, c - a);
        angles[3 * f + 1] = angle_between(c - b, a - b);
        angles[3 * f + 2] = angle_between(a - c, b - c);
    }

    // Corners in order of their position: begin[p] .. begin[p + 1] of `sorted` are those at the place of corner p.
    const std::vector<std::uint32_t> place = first_equal(
        corner_count, [&](std::size_t i) { return hash_of(position(i)); },
        [&](std::size_t i, std::size_t j) {
            const Vec3d p = position(i), q = position(j);
            return p.x == q.x && p.y == q.y && p.z == q.z;
        });
    std::vector<std::uint32_t> begin(corner_count + 1, 0), sorted(corner_count);
    for (const std::uint32_t p : place) ++begin[p + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
    for (std::uint32_t i = 0; i < corner_count; ++i) sorted[next[place[i]]++] = i;

    std::vector<Vec3f> normals(corner_count, Vec3f{0, 0, 0});
    for (std::size_t i = 0; i < corner_count; ++i) {
        const std::uint32_t from = begin[place[i]], to = begin[place[i] + 1];
        if (to - from > most_faces) continue;
        const Vec3d own = face_normals[i / 3];
        Vec3d sum = {0, 0, 0};
        for (std::uint32_t k = from; k < to; ++k) {
            const Vec3d other = face_normals[sorted[k] / 3];
            if (dot(own, other) >= cos_crease) sum += angles[sorted[k]] * other;
        }
        if (length(sum) > 0) normals[i] = static_cast<Vec3f>(normalized(sum));
    }

    for (std::size_t i = 0; i < corner_count; ++i) {
        std::uint32_t& vertex = scene.triangles[triangles[i / 3]].vertices[i % 3];
        scene.positions_m.push_back(scene.positions_m[vertex]);
        scene.normals.push_back(normals[i]);
        if (!scene.uvs.empty()) scene.uvs.push_back(scene.uvs[vertex]);
        vertex = static_cast<std::uint32_t>(scene.positions_m.size() - 1);
    }
}

}  // namespace realcam::io
