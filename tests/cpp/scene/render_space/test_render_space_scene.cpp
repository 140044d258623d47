// A scene as kernels read it: large triangles in pieces, planes and normals of slivers.

#include <algorithm>
#include <cmath>
#include <vector>

#include "measurement.hpp"
#include "scene/geometry/surface_point.hpp"
#include "scene/render_space/render_space_scene.hpp"
#include "traced_ray.hpp"

using namespace realcam;
using namespace realcam::test;

namespace {

Checkpoint unasked;

Scene scene_of(std::vector<Vec3d> positions, std::vector<Triangle> triangles) {
    Scene scene;
    scene.positions_m = std::move(positions);
    scene.triangles = std::move(triangles);
    scene.materials = {Material{}};
    return scene;
}

// A rectangle of two triangles about a point, with uvs that are its coordinates over its half size.
Scene ground(Vec3d middle, double half, Vec3d right, Vec3d up) {
    Scene scene = scene_of({middle - half * (right + up), middle + half * (right - up), middle + half * (right + up),
                            middle - half * (right - up)},
                           {{{0, 1, 2}, 0}, {{0, 2, 3}, 0}});
    scene.uvs = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    scene.normals = {{0, 1, 0}, {0.6f, 0.8f, 0}, {0, 0.6f, 0.8f}, {0, 1, 0}};
    return scene;
}

const Vec3d kPlaneRight = normalized(Vec3d{1, -0.3, 0.1}),
            kPlaneUp = normalized(cross(kPlaneRight, Vec3d{0.2, 1, 0.3}));
const Vec3d kPlaneNormal = cross(kPlaneRight, kPlaneUp);

// Positions of the ground's centre relative to the camera, which is above the centre, an edge and a corner, beside the
// ground, in its plane, and almost in its plane.
std::vector<Vec3d> middles(double half) {
    return {-1.5 * kPlaneNormal + Vec3d{0.2, 0.1, 0},
            -1.5 * kPlaneNormal + half * kPlaneRight,
            -20.0 * kPlaneNormal + half * (kPlaneRight + kPlaneUp),
            -1.5 * kPlaneNormal + (half + 3) * kPlaneRight,
            0.3 * kPlaneRight + 0.1 * kPlaneUp,
            -1e-6 * kPlaneNormal + 7.0 * kPlaneUp};
}

double distance_to_segment(Vec3d p, Vec3d a, Vec3d b) {
    const Vec3d d = b - a;
    const double t = std::clamp(dot(p - a, d) / dot(d, d), 0.0, 1.0);
    return length(p - a - t * d);
}

// Distance from the origin to a triangle.
double distance_to(Vec3d a, Vec3d b, Vec3d c) {
    const Vec3d n = normalized(cross(b - a, c - a)), foot = dot(a, n) * n;
    const auto left = [&](Vec3d p, Vec3d q) { return dot(cross(q - p, foot - p), n) >= 0; };
    if (left(a, b) && left(b, c) && left(c, a)) return length(foot);
    return std::min({distance_to_segment({0, 0, 0}, a, b), distance_to_segment({0, 0, 0}, b, c),
                     distance_to_segment({0, 0, 0}, c, a)});
}

// Largest distance of float corners from the plane, over the distance of their triangle.
double displacement(const std::vector<Triangle>& triangles, const std::vector<Vec3f>& positions, Vec3d normal,
                    double height) {
    double worst = 0;
    for (const Triangle& t : triangles) {
        Vec3d p[3];
        for (int i = 0; i < 3; ++i) p[i] = static_cast<Vec3d>(positions[t.vertices[i]]);
        const double distance = std::max(distance_to(p[0], p[1], p[2]), 0.01);
        for (const Vec3d& corner : p) worst = std::max(worst, std::fabs(dot(corner, normal) - height) / distance);
    }
    return worst;
}

}  // namespace

TEST_CASE("large triangles come in pieces that fit together and cover the same") {
    double worst = 0, uncut = 0;
    std::size_t most = 0;
    for (const double half : {1e5, 1e8})
        for (const Vec3d& middle : middles(half)) {
            CAPTURE(half);
            const Scene scene = ground(middle, half, kPlaneRight, kPlaneUp);
            const SplitTriangles split(scene, relative_to({0, 0, 0}), LargeTriangles::cut, unasked);
            REQUIRE(split.any());
            most = std::max(most, split.triangles().size());
            double area = 0;
            for (std::size_t i = 0; i < split.triangles().size(); ++i) {
                const Triangle& t = split.triangles()[i];
                const Vec3d a = split.position(t.vertices[0]), b = split.position(t.vertices[1]),
                            c = split.position(t.vertices[2]);
                const Vec3d twice = cross(b - a, c - a);
                CHECK(dot(twice, kPlaneNormal) > 0);
                CHECK(split.parent(i) < 2);
                area += 0.5 * length(twice);
                // No corner of another piece lies inside an edge, where a gap could open.
                for (std::size_t v = 0; v < split.position_count(); ++v) {
                    const Vec3d p = split.position(v);
                    for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) {
                        const double size = length(to - from);
                        if (length(p - from) < 1e-9 * size || length(p - to) < 1e-9 * size) continue;
                        REQUIRE(distance_to_segment(p, from, to) > 1e-9 * size);
                    }
                }
            }
            CHECK(std::fabs(area / (4 * half * half) - 1) < 1e-9);
            const RenderSpaceScene placed(scene, {0, 0, 0});
            const double height = dot(middle, kPlaneNormal);
            worst = std::max(worst, displacement(placed.static_geometry().triangles(),
                                                 placed.static_geometry().positions(), kPlaneNormal, height));
            std::vector<Vec3f> corners;
            for (const Vec3d& p : scene.positions_m) corners.push_back(static_cast<Vec3f>(p));
            uncut = std::max(uncut, displacement(scene.triangles, corners, kPlaneNormal, height));
        }
    CHECK(most < 300);
    // Pieces are up to 128 times as large as their distance; corners of the largest lie twice as far, and round by
    // 2^-25 in three coordinates.
    const double limit = 256 * std::sqrt(3.0) * 0x1p-25;
    hold({"Scenes", "float corners of a large ground, off its plane", "6 places of the camera, 1e5 and 1e8 m", "core",
          "float32", worst, limit, "of the distance"});
    breaks({"Scenes", "float corners of a large ground that is not cut", "6 places of the camera, 1e5 and 1e8 m",
            "core", "float32", uncut, limit, "of the distance"});
}

TEST_CASE("what is not large for its distance stays as it is") {
    const Scene scene = ground({0, -1.5, 0}, 60, {1, 0, 0}, {0, 0, -1});
    const SplitTriangles split(scene, relative_to({0, 0, 0}), LargeTriangles::cut, unasked);
    CHECK(!split.any());
    CHECK(&split.triangles() == &scene.triangles);
    CHECK(&split.normals() == &scene.normals);
    // From afar the largest one is small.
    const Scene large = ground({0, 0, -1e9}, 1e8, kPlaneRight, kPlaneUp);
    CHECK(!SplitTriangles(large, relative_to({0, 0, 0}), LargeTriangles::cut, unasked).any());
}

TEST_CASE("normals and texture coordinates of a piece are those of the whole") {
    const Vec3d middle = middles(1e5)[0];
    const Scene scene = ground(middle, 1e5, kPlaneRight, kPlaneUp);
    const RenderSpaceScene placed(scene, {0, 0, 0});
    const SceneView view = placed.view();
    const SplitTriangles split(scene, relative_to({0, 0, 0}), LargeTriangles::cut, unasked);
    for (std::size_t i = 0; i < split.triangles().size(); ++i)
        for (const std::uint32_t v : split.triangles()[i].vertices) {
            const Vec3d p = split.position(v) - middle;
            CHECK(std::fabs(static_cast<double>(view.uvs[v].x) - dot(p, kPlaneRight) / 1e5) < 1e-6);
            CHECK(std::fabs(static_cast<double>(view.uvs[v].y) - dot(p, kPlaneUp) / 1e5) < 1e-6);
            const double s = 0.5 * (dot(p, kPlaneRight) / 1e5 + 1), t = 0.5 * (dot(p, kPlaneUp) / 1e5 + 1);
            const Vec3f* n = scene.normals.data();
            const Vec3d expected = split.parent(i) == 0
                                       ? (1 - s) * static_cast<Vec3d>(n[0]) + (s - t) * static_cast<Vec3d>(n[1]) +
                                             t * static_cast<Vec3d>(n[2])
                                       : (1 - t) * static_cast<Vec3d>(n[0]) + s * static_cast<Vec3d>(n[2]) +
                                             (t - s) * static_cast<Vec3d>(n[3]);
            CHECK(length(static_cast<Vec3d>(view.normals[v]) - expected) < 1e-6);
            const Vec3f whole = view.planes[i].normal;
            CHECK(length(static_cast<Vec3d>(whole) - kPlaneNormal) < 2e-7);
        }
}

TEST_CASE("slivers have the normal of their double corners, and points on them lie on the ray") {
    Random random(4);
    double normal_error = 0, float_normal_error = 0, place_error = 0;
    for (int i = 0; i < 20000; ++i) {
        const double thin = std::pow(10.0, -random.between(2, 8));
        const auto any = [&] { return Vec3d{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)}; };
        const Vec3d a = 3.0 * any() + Vec3d{0, 0, -6}, u = normalized(any());
        const Vec3d n = normalized(cross(u, any())), side = cross(n, u);
        // The third corner lies beside the long edge.
        const Scene scene = scene_of({a, a + u, a + random.between(0.2, 0.8) * u + thin * side}, {{{0, 1, 2}, 0}});
        const RenderSpaceScene placed(scene, {0, 0, 0});
        const SceneView view = placed.view();
        normal_error = std::max(normal_error, length(static_cast<Vec3d>(view.planes[0].normal) - n));
        const Vec3d p = a + 0.5 * u + 0.3 * thin * side, to = normalized(p);
        if (std::fabs(dot(to, n)) < 0.1) continue;
        // The hit as traversal reports it, with barycentric coordinates as uncertain as float edges make them.
        const double u_share = (0.5 + random.between(-1, 1) * std::min(6e-8 * 6 / thin, 0.3));
        const Hit hit{static_cast<float>(length(p)), 0, static_cast<float>(u_share), 0.0f};
        const SurfacePoint point = surface_point<SceneKind::any>(view, hit, {0, 0, 0}, static_cast<Vec3f>(to), 0);
        place_error = std::max(place_error, length(static_cast<Vec3d>(point.position) - p) / length(p));
        const Vec3f* corner = view.positions;
        const Vec3f area = cross(corner[1] - corner[0], corner[2] - corner[0]);
        float_normal_error =
            std::max(float_normal_error, length((1 / length(static_cast<Vec3d>(area))) * static_cast<Vec3d>(area) - n));
    }
    const char* tried = "20000 random slivers of 1e2 : 1 to 1e8 : 1";
    // Doubles of 9 m round to 1e-15 m, 1e-7 of the thinnest; then to 24 bits.
    hold({"Scenes", "normal of slivers", tried, "core", "float32", normal_error, 5e-7, "radians"});
    breaks({"Scenes", "normal of slivers, from float corners", tried, "core", "float32", float_normal_error, 5e-7,
            "radians"});
    // Roundings of the ray's direction, its length, their product and the distance to the plane, at 6 degrees or more.
    hold({"Scenes", "point on a sliver", tried, "core", "float32", place_error, 8 * 0x1p-24, "of the distance"});
}

TEST_CASE("a ray from afar meets a small triangle where its corners say") {
    const Vec3d a{0.3, -0.2, -1}, b{1.1, 0.1, -1.2}, c{0.2, 0.9, -0.9};
    const Scene scene = scene_of({a, b, c}, {{{0, 1, 2}, 0}});
    const RenderSpaceScene placed(scene, {0, 0, 0});
    const Vec3d expected = 0.5 * a + 0.3 * b + 0.2 * c, from = expected + 1e7 * normalized(Vec3d{0.3, 0.4, 1});
    const Hit hit{1e7f, 0, 0.3f, 0.2f};
    const Vec3f way = static_cast<Vec3f>(normalized(expected - from));
    const SurfacePoint point = surface_point<SceneKind::any>(placed.view(), hit, static_cast<Vec3f>(from), way, 0);
    // The spacing of floats along this ray is 1 m.
    CHECK(length(static_cast<Vec3d>(point.position) - expected) < 8 * 0x1p-24);
}

TEST_CASE("triangles without area and corners in one place give finite planes") {
    const Scene scene =
        scene_of({{0, 0, -1}, {1, 0, -1}, {2, 0, -1}}, {{{0, 0, 0}, 0}, {{0, 1, 2}, 0}, {{0, 1, 1}, 0}});
    const RenderSpaceScene placed(scene, {0, 0, 0});
    for (int i = 0; i < 3; ++i) {
        const SurfacePoint point = surface_point<SceneKind::any>(
            placed.view(), {1, static_cast<std::uint32_t>(i), 0.2f, 0.2f}, {0, 0, 0}, {0, 0, -1}, 0);
        CHECK(std::isfinite(length(point.position) + length(point.normal) + point.self_offset));
        CHECK(std::fabs(length(point.normal) - 1) < 1e-6f);
    }
}
