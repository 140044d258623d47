// Surfaces that image one pair of points perfectly: every ray must meet the image point, and all must have
// the same optical path. Closed forms; the tolerances are rounding in double precision.

#include <cmath>

#include "about.hpp"
#include "doctest/doctest.h"
#include "traced_ray.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

constexpr double kSpot = 1e-9;  // mm, what the closed forms are asked for

// How far a ray, as a straight line, passes from a point of the axis.
double miss(const TracedRay& ray, double z) {
    const Vec3d to_point = Vec3d{0, 0, z} - ray.origin;
    return length(cross(to_point, ray.direction));
}

Vec3d direction_from_axis(double angle, double azimuth, double towards) {
    return {std::sin(angle) * std::cos(azimuth), std::sin(angle) * std::sin(azimuth), towards * std::cos(angle)};
}

// Parallel rays over a disc, from the plane z = -10.
template <class Check>
void for_parallel_rays(const LensSystem& lens, double radius, Check&& check) {
    const RayTracer trace(lens, LightDirection::to_film);
    for (int i = 1; i <= 50; ++i) {
        const double r = radius * i / 50, azimuth = 2.4 * i;
        const TracedRay ray = trace({r * std::cos(azimuth), r * std::sin(azimuth), -10}, {0, 0, 1});
        REQUIRE(ray.passed());
        check(ray, r);
    }
}

}  // namespace

TEST_CASE("a sphere images its aplanatic points on each other") {
    for (const double n : {1.3, 1.5168, 2.0})
        for (const double R : {2.0, 30.0}) {
            // Glass behind the surface; the points lie R/n and R n behind the centre, the latter virtual.
            const LensSystem lens = lens_of({refracting(R, 0, Glass::constant(n), R)});
            const double inside = R + R / n, outside = R + R * n;
            const RayTracer to_scene(lens, LightDirection::to_scene), to_film(lens, LightDirection::to_film);
            for (int i = 1; i <= 40; ++i) {
                // Up to where the ray meets the sphere's equator.
                const double angle = std::atan(n) * i / 41, azimuth = 2.4 * i;
                const TracedRay out = to_scene({0, 0, inside}, direction_from_axis(angle, azimuth, -1));
                REQUIRE(out.passed());
                CHECK(miss(out, outside) < kSpot);
                // n |O P| - |P I| is the same for all rays; on the axis it is n (R + R/n) - (R + R n) = 0.
                CHECK(std::fabs(out.optical_path - length(out.origin - Vec3d{0, 0, outside})) < kSpot);
                // Abbe's sine condition, which makes the points aplanatic: sin u / sin u' = n for all rays.
                CHECK(std::sin(angle) == about(n * std::hypot(out.direction.x, out.direction.y), 1e-12));

                const TracedRay back = to_film(out.origin + 50.0 * out.direction, -out.direction);
                REQUIRE(back.passed());
                CHECK(miss(back, inside) < kSpot);
            }
        }
}

TEST_CASE("a paraboloid mirror images infinity on its focus") {
    Surface mirror = refracting(-200, 0, Glass::air(), 150);
    mirror.type = SurfaceType::mirror;
    mirror.conic = -1;
    // To 150 mm of a focal length of 100: rays that leave at more than 70 degrees.
    for_parallel_rays(lens_of({mirror}), 150, [](const TracedRay& ray, double r) {
        CHECK(ray.origin.z == about(-r * r / 400, 1e-13));  // the paraboloid itself
        CHECK(ray.direction.z < 0);
        CHECK(miss(ray, -100) < kSpot);
        // From the plane z = -10 to the focus: 10 to the vertex, 100 back.
        CHECK(std::fabs(ray.optical_path + length(ray.origin - Vec3d{0, 0, -100}) - 110) < kSpot);
    });
}

TEST_CASE("an ellipsoid mirror images one focus on the other") {
    // k = -e^2; the foci lie |R| / (1 + e) and |R| / (1 - e) from the vertex.
    const double R = 100, e = 0.6, near = R / (1 + e), far = R / (1 - e);
    Surface mirror = refracting(-R, 0, Glass::air(), 100);
    mirror.type = SurfaceType::mirror;
    mirror.conic = -e * e;
    const RayTracer trace(lens_of({mirror}), LightDirection::to_film);
    for (int i = 1; i <= 40; ++i) {
        const TracedRay ray = trace({0, 0, -near}, direction_from_axis(0.03 * i, 2.4 * i, 1));
        REQUIRE(ray.passed());
        CHECK(miss(ray, -far) < kSpot);
        CHECK(std::fabs(ray.optical_path + length(ray.origin - Vec3d{0, 0, -far}) - (near + far)) < kSpot);
    }
}

TEST_CASE("a refracting ellipsoid of conic -1/n^2 images infinity into the glass") {
    for (const double n : {1.5, 1.9}) {
        Surface surface = refracting(50, 0, Glass::constant(n), 0);
        surface.conic = -1 / (n * n);
        surface.clear_semi_diameter = 0.99 * 50 / std::sqrt(1 - 1 / (n * n));  // nearly to the ellipsoid's equator
        const double focus = n * 50 / (n - 1);
        for_parallel_rays(lens_of({surface}), surface.clear_semi_diameter * 0.999, [&](const TracedRay& ray, double) {
            CHECK(miss(ray, focus) < kSpot);
            const double path = ray.optical_path + n * length(ray.origin - Vec3d{0, 0, focus});
            CHECK(std::fabs(path - (10 + n * focus)) < kSpot);
        });
    }
}

TEST_CASE("a plano-convex lens of conic -n^2 images infinity on its focus") {
    for (const double n : {1.5, 1.9}) {
        Surface front = refracting(0, 12, Glass::constant(n), 40), back = refracting(-30, 0, Glass::air(), 40);
        back.conic = -n * n;
        const double focus = 12 + 30 / (n - 1);
        for_parallel_rays(lens_of({front, back}), 39, [&](const TracedRay& ray, double) {
            CHECK(miss(ray, focus) < kSpot);
            const double path = ray.optical_path + length(ray.origin - Vec3d{0, 0, focus});
            CHECK(std::fabs(path - (10 + 12 * n + 30 / (n - 1))) < kSpot);
        });
    }
}

TEST_CASE("the same conic as an even asphere with a negligible term takes the other code path to the same place") {
    for (const double conic : {0.0, -0.6, -2.25, 0.4}) {
        Surface surface = refracting(30, 0, Glass::constant(1.6), 18);
        surface.conic = conic;
        Surface asphere = surface;
        asphere.aspheric = {0, 0, 0, 1e-40};  // 1e-30 mm at the rim
        const RayTracer closed(lens_of({surface}), LightDirection::to_film);
        const RayTracer searched(lens_of({asphere}), LightDirection::to_film);
        Random random(1);
        for (int i = 0; i < 500; ++i) {
            const Vec3d target{random.between(-5, 5), random.between(-5, 5), 0};
            const Vec3d origin{random.between(-8, 8), random.between(-8, 8), -15};
            const TracedRay a = closed(origin, target - origin), b = searched(origin, target - origin);
            REQUIRE(a.passed());
            REQUIRE(b.passed());
            // The search ends within 4 roundings of some 30 mm, far from grazing.
            CHECK(length(a.origin - b.origin) < 2e-13);
            CHECK(length(a.direction - b.direction) < 2e-14);
        }
    }
}

TEST_CASE("a whole sphere is met on its near cap, whatever the ray's direction") {
    // A ball lens's front cap of radius 10, semi-diameter 10: rays that run towards the film at up to 90
    // degrees and beyond (in front of the lens they run backwards: the fisheyes past the hemisphere).
    const LensSystem lens = lens_of({refracting(10, 0, Glass::constant(1.5), 10)});
    const RayTracer trace(lens, LightDirection::to_film);
    for (double polar = 1; polar < 89; polar += 4)
        for (const double incidence : {0.0, 30.0, -30.0, 60.0, -60.0}) {
            const double theta = polar * M_PI / 180, turn = (polar + incidence) * M_PI / 180;
            // Surface point at the polar angle from the centre; the ray comes along the normal turned by
            // `incidence`.
            const Vec3d point{10 * std::sin(theta), 0, 10 - 10 * std::cos(theta)};
            const Vec3d direction{-std::sin(turn), 0, std::cos(turn)};
            const TracedRay ray = trace(point - 7.0 * direction, direction);
            REQUIRE(ray.passed());
            CHECK(length(ray.origin - point) < 1e-12);
            CHECK(ray.optical_path == about(7, 1e-12));
            // Snell's law about the normal.
            const Vec3d normal{-std::sin(theta), 0, std::cos(theta)};
            const double sine = length(cross(ray.direction, normal));
            CHECK(std::fabs(1.5 * sine - std::sin(std::fabs(incidence) * M_PI / 180)) < 1e-13);
            CHECK(length(ray.direction) == about(1, 1e-14));
        }
}

TEST_CASE("a ray that starts on the far side of a sphere crosses it to the near cap") {
    // A concave front: the centre lies on the scene's side, and the whole ball of radius 10 in front of the vertex.
    // From the ball's other side one root of the quadratic is 0, and the other one is wanted.
    const RayTracer trace(lens_of({refracting(-10, 0, Glass::constant(1.5), 10)}), LightDirection::to_film);
    for (const double polar : {0.0, 0.3, -0.8, 1.2})
        for (const double start : {0.0, 1e-9, -1e-9, 1e-4, 30.0}) {
            // Through the middle of the ball, so that it is met along its normal.
            const Vec3d direction{std::sin(polar), 0, std::cos(polar)};
            const TracedRay ray = trace(Vec3d{0, 0, -10} - (10 + start) * direction, direction);
            REQUIRE(ray.passed());
            CHECK(ray.optical_path == about(20 + start, 1e-14));
            CHECK(length(ray.direction - direction) < 1e-14);
        }
}
