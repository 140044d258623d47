#pragma once
// Scenes of simple shapes: boxes, spheres, floors.

#include <array>
#include <cmath>
#include <numbers>

#include "scene/scene.hpp"

namespace realcam::test {

struct Extent {
    Vec3d low, high;
};

/// A rectangle from a corner along two edges, in n x n squares of two triangles; its normal is along u x v.
inline void add_patch(Scene& scene, Vec3d corner, Vec3d u, Vec3d v, int n = 1) {
    const auto first = static_cast<std::uint32_t>(scene.positions_m.size());
    for (int i = 0; i <= n; ++i)
        for (int k = 0; k <= n; ++k)
            scene.positions_m.push_back(corner + (static_cast<double>(i) / n) * u + (static_cast<double>(k) / n) * v);
    const auto row = static_cast<std::uint32_t>(n + 1);
    for (std::uint32_t i = 0; i + 1 < row; ++i)
        for (std::uint32_t k = 0; k + 1 < row; ++k) {
            const std::uint32_t a = first + i * row + k, b = a + row;
            scene.triangles.push_back({{a, b, b + 1}, 0});
            scene.triangles.push_back({{a, b + 1, a + 1}, 0});
        }
}

/// Six sides with normals outwards, or inwards; `open`: without the one towards +z.
inline void add_box(Scene& scene, const Extent& box, bool inwards = false, bool open = false) {
    const Vec3d a = box.low, s = box.high - box.low;
    const std::array<Vec3d, 3> edges = {{{s.x, 0, 0}, {0, s.y, 0}, {0, 0, s.z}}};
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const bool high : {false, true}) {
            if (open && axis == 2 && high) continue;
            const Vec3d corner = high ? a + edges[axis] : a;
            const Vec3d u = edges[(axis + 1) % 3], v = edges[(axis + 2) % 3];
            high != inwards ? add_patch(scene, corner, u, v) : add_patch(scene, corner, v, u);
        }
}

/// The part of a sphere above `lowest` times its radius, of 2 n by n patches.
inline void add_sphere(Scene& scene, Vec3d middle, double radius, int n, double lowest = -1) {
    const auto first = static_cast<std::uint32_t>(scene.positions_m.size());
    const double top = std::numbers::pi / 2, bottom = std::asin(lowest);
    for (int i = 0; i <= n; ++i)
        for (int k = 0; k <= 2 * n; ++k) {
            const double up = bottom + (top - bottom) * i / n, around = std::numbers::pi * k / n;
            scene.positions_m.push_back(middle + radius * Vec3d{std::cos(up) * std::cos(around), std::sin(up),
                                                                std::cos(up) * std::sin(around)});
        }
    const auto row = static_cast<std::uint32_t>(2 * n + 1);
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(n); ++i)
        for (std::uint32_t k = 0; k + 1 < row; ++k) {
            const std::uint32_t a = first + i * row + k, b = a + row;
            scene.triangles.push_back({{a, b, b + 1}, 0});
            scene.triangles.push_back({{a, b + 1, a + 1}, 0});
        }
}

inline Scene grey_scene() {
    Scene scene;
    scene.materials.resize(1);
    return scene;
}

}  // namespace realcam::test
