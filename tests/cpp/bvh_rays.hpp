#pragma once
// Meshes and rays for the tests of the BVH, and reference intersections in double precision.

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "bvh/build_wide_bvh.hpp"
#include "bvh/traverse_wide_bvh.hpp"
#include "scene/materials/light_sample.hpp"
#include "scene/scene.hpp"

namespace realcam::test {

struct Mesh {
    std::vector<Vec3f> positions;
    std::vector<Triangle> triangles;

    void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) { triangles.push_back({{a, b, c}, 0}); }
    void add(Vec3f a, Vec3f b, Vec3f c) {
        const auto first = static_cast<std::uint32_t>(positions.size());
        positions.insert(positions.end(), {a, b, c});
        add(first, first + 1, first + 2);
    }
    Box box(std::uint32_t triangle) const {
        const std::uint32_t* v = triangles[triangle].vertices;
        return box_of({positions[v[0]], 0, positions[v[1]], 0, positions[v[2]], 0});
    }
    WideBvh bvh() const { return build_wide_bvh(positions, triangles); }
};

/// A mesh of one material as an object of an assembly.
inline std::shared_ptr<const Scene> scene_of(const Mesh& mesh, const Material& material = {}) {
    Scene scene;
    for (const Vec3f p : mesh.positions) scene.positions_m.push_back(static_cast<Vec3d>(p));
    scene.triangles = mesh.triangles;
    scene.materials = {material};
    return std::make_shared<const Scene>(scene);
}

struct BvhRay {
    Vec3f origin, direction;
    float far = kFarAway;
};

class BvhDraw {
public:
    explicit BvhDraw(std::uint32_t seed) : bits_(seed) {}

    float within(float a, float b) { return a + (b - a) * (static_cast<float>(bits_() >> 8) * 0x1p-24f); }
    std::uint32_t below(std::size_t n) { return static_cast<std::uint32_t>(bits_() % n); }
    Vec3f in_cube(float half) { return {within(-half, half), within(-half, half), within(-half, half)}; }
    Vec3f direction() {
        for (;;) {
            const Vec3f d = in_cube(1);
            if (dot(d, d) > 0.01f && dot(d, d) < 1) return normalized(d);
        }
    }

private:
    std::mt19937 bits_;
};

inline Mesh soup(std::size_t count, float room, float size, std::uint32_t seed) {
    BvhDraw draw(seed);
    Mesh mesh;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3f middle = draw.in_cube(room);
        mesh.add(middle + draw.in_cube(size), middle + draw.in_cube(size), middle + draw.in_cube(size));
    }
    return mesh;
}

// A closed mesh that is seen from inside: a sphere with bumps, the poles fans, no seam.
inline Mesh potato(int rings, int sectors, Vec3f middle, float radius, float bump) {
    Mesh mesh;
    const auto place = [&](double polar, double azimuth) {
        const double r =
            static_cast<double>(radius) * (1 + static_cast<double>(bump) * std::sin(5 * polar) * std::cos(4 * azimuth));
        return middle + Vec3f{static_cast<float>(r * std::sin(polar) * std::cos(azimuth)),
                              static_cast<float>(r * std::cos(polar)),
                              static_cast<float>(r * std::sin(polar) * std::sin(azimuth))};
    };
    const double pi = 3.141592653589793;
    mesh.positions = {place(0, 0), place(pi, 0)};
    for (int i = 1; i < rings; ++i)
        for (int j = 0; j < sectors; ++j) mesh.positions.push_back(place(pi * i / rings, 2 * pi * j / sectors));
    const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(2 + (i - 1) * sectors + j % sectors); };
    for (int j = 0; j < sectors; ++j) {
        mesh.add(0, at(1, j), at(1, j + 1));
        mesh.add(1, at(rings - 1, j + 1), at(rings - 1, j));
        for (int i = 1; i + 1 < rings; ++i) {
            mesh.add(at(i, j), at(i + 1, j), at(i, j + 1));
            mesh.add(at(i, j + 1), at(i + 1, j), at(i + 1, j + 1));
        }
    }
    return mesh;
}

// Triangles whose sizes and positions span orders of magnitude; a ray from the corner may hit any of them.
inline Mesh many_sizes(int count, double orders, std::uint32_t seed) {
    BvhDraw draw(seed);
    Mesh mesh;
    for (int i = 0; i < count; ++i) {
        const auto size = static_cast<float>(std::pow(10.0, orders * (i / (count - 1.0) - 0.5)));
        const Vec3f middle = size * (Vec3f{3, 3, 3} + draw.in_cube(1));
        mesh.add(middle + draw.in_cube(size), middle + draw.in_cube(size), middle + draw.in_cube(size));
    }
    return mesh;
}

struct ExactHit {
    double distance = std::numeric_limits<double>::infinity();
    double u = 0, v = 0;
    double margin = 0;  // least barycentric: how far inside the triangle, or outside if negative
};

// Intersection with one triangle in double precision, by Moller and Trumbore: independent of the routine under test.
inline ExactHit exact_hit(const Mesh& mesh, std::size_t triangle, const BvhRay& ray) {
    const std::uint32_t* corner = mesh.triangles[triangle].vertices;
    const auto a = static_cast<Vec3d>(mesh.positions[corner[0]]);
    const Vec3d e1 = static_cast<Vec3d>(mesh.positions[corner[1]]) - a;
    const Vec3d e2 = static_cast<Vec3d>(mesh.positions[corner[2]]) - a;
    const auto d = static_cast<Vec3d>(ray.direction);
    const Vec3d p = cross(d, e2), from = static_cast<Vec3d>(ray.origin) - a, q = cross(from, e1);
    const double det = dot(e1, p);
    ExactHit hit;
    hit.margin = -std::numeric_limits<double>::infinity();
    if (det == 0) return hit;
    hit.u = dot(from, p) / det;
    hit.v = dot(d, q) / det;
    hit.distance = dot(e2, q) / det;
    hit.margin = std::min({hit.u, hit.v, 1 - hit.u - hit.v});
    return hit;
}

// Error bounds of the barycentrics and of the distance due to float corners relative to the ray's origin: 16 roundings
// of the farthest corner's distance, over the triangle's smallest height projected along the ray, or over the cosine.
struct Uncertainty {
    double barycentric, distance;
};
inline Uncertainty uncertainty(const Mesh& mesh, std::size_t triangle, const BvhRay& ray) {
    Vec3d p[3];
    double far = 0;
    for (int i = 0; i < 3; ++i) {
        p[i] =
            static_cast<Vec3d>(mesh.positions[mesh.triangles[triangle].vertices[i]]) - static_cast<Vec3d>(ray.origin);
        far = std::max(far, length(p[i]));
    }
    const Vec3d d = normalized(static_cast<Vec3d>(ray.direction)), area = cross(p[1] - p[0], p[2] - p[0]);
    const double longest = std::max({length(p[1] - p[0]), length(p[2] - p[1]), length(p[0] - p[2])});
    const double seen = std::fabs(dot(area, d)), rounding = 16 * 0x1p-24 * far;
    return {rounding * longest / seen, rounding * length(area) / seen};
}

// Compares traversal with an intersection of every triangle in double precision. False if the results differ by more
// than float corners explain.
inline bool agrees(const Mesh& mesh, const WideBvhView& bvh, const BvhRay& ray) {
    const Hit hit = closest_hit(bvh, ray.origin, ray.direction, ray.far);
    const double unit = length(static_cast<Vec3d>(ray.direction)), far = static_cast<double>(ray.far);
    if (any_hit(bvh, ray.origin, ray.direction, ray.far) != (hit.triangle != kNoTriangle)) return false;
    double distance = far;
    if (hit.triangle != kNoTriangle) {
        if (hit.triangle >= mesh.triangles.size()) return false;
        const ExactHit exact = exact_hit(mesh, hit.triangle, ray);
        const Uncertainty may = uncertainty(mesh, hit.triangle, ray);
        distance = static_cast<double>(hit.distance);
        if (!(distance >= 0 && distance < far)) return false;
        // If the triangle is seen edge-on, its barycentrics and distance are too uncertain to be checked.
        if (may.barycentric < 0.5) {
            if (exact.margin < -may.barycentric) return false;
            if (std::fabs(distance - exact.distance) * unit > may.distance) return false;
            if (std::fabs(static_cast<double>(hit.u) - exact.u) > may.barycentric) return false;
            if (std::fabs(static_cast<double>(hit.v) - exact.v) > may.barycentric) return false;
        }
    }
    // No triangle may be hit and be nearer by more than the uncertainties.
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const ExactHit exact = exact_hit(mesh, i, ray);
        if (!(exact.margin > 0)) continue;
        const Uncertainty may = uncertainty(mesh, i, ray);
        if (exact.margin <= may.barycentric) continue;
        const double slack = may.distance / unit;
        if (exact.distance > slack && exact.distance + slack < distance - (hit.triangle == kNoTriangle ? 0 : slack))
            return false;
    }
    return true;
}

inline BvhRay ray_between(Vec3f from, Vec3f to) {
    return {from, to - from};
}

}  // namespace realcam::test
