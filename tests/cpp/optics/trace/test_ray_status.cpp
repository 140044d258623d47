// How rays end: each cause has its status, and rays that have ended stay as they are.

#include <cmath>
#include <limits>
#include <vector>

#include "about.hpp"
#include "doctest/doctest.h"
#include "optics/centred_lenses.hpp"
#include "traced_ray.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

RayStatus status_without_record(const LensSystem& lens, Vec3d origin, Vec3d direction) {
    const LensPath<float> path(lens, LightDirection::to_film, lens.wavelength_nm);
    LensRays<float, 1> ray;
    ray.origin.set(0, static_cast<Vec3f>(origin));
    ray.direction.set(0, static_cast<Vec3f>(direction));
    ray.status[0] = 0;
    trace_lens(path.view(), ray);
    return static_cast<RayStatus>(ray.status[0]);
}

}  // namespace

TEST_CASE("each cause of a ray's end has its status") {
    // Surface 2 is a hemisphere of radius 10 with a rim of 8; surface 4 leaves glass of 1.5: critical
    // angle 41.81 deg.
    LensSystem lens =
        lens_of({stop_plane(5, 40), refracting(10, 5, Glass::constant(1.5), 8), refracting(0, 5, Glass::air(), 40)});
    const RayTracer trace(lens, LightDirection::to_film);

    const TracedRay ok = trace({0, 1, -1}, {0, 0, 1});
    CHECK(ok.status == RayStatus::ok);
    CHECK(ok.surface_index == 2);

    const TracedRay missed = trace({0, 10.5, -1}, {0, 0, 1});
    CHECK(missed.status == RayStatus::missed);
    CHECK(missed.surface_index == 1);
    CHECK(missed.direction.z == 1);  // the last direction it had

    const TracedRay vignetted = trace({0, 9, -1}, {0, 0, 1});
    CHECK(vignetted.status == RayStatus::vignetted);
    CHECK(vignetted.surface_index == 1);
    CHECK(vignetted.origin.y == 9);
    CHECK(vignetted.origin.z == about(5 + 10 - std::sqrt(19.0), 1e-14));  // on that surface
    CHECK(status_without_record(lens, {0, 9, -1}, {0, 0, 1}) == RayStatus::vignetted);
    CHECK(status_without_record(lens, {0, 10.5, -1}, {0, 0, 1}) != RayStatus::ok);

    CHECK(trace({0, 41, -1}, {0, 0, 1}).surface_index == 0);
}

TEST_CASE("rays beyond the critical angle are reflected totally, and those below are not") {
    const LensSystem lens = lens_of({refracting(0, 5, Glass::constant(1.5), 100), refracting(0, 0, Glass::air(), 100)});
    // Glass behind the lens: light to the scene starts in it.
    const LensSystem from_glass = lens_of({refracting(0, 0, Glass::constant(1.5), 100)});
    const RayTracer to_scene(from_glass, LightDirection::to_scene);
    const double critical = std::asin(1 / 1.5);
    for (const double angle : {0.2, critical - 1e-6, critical + 1e-6, 1.2}) {
        const TracedRay ray = to_scene({0, 0, 1}, {std::sin(angle), 0, -std::cos(angle)});
        CHECK(ray.status == (angle < critical ? RayStatus::ok : RayStatus::total_internal_reflection));
        if (!ray.passed()) CHECK(ray.direction.x == about(std::sin(angle), 1e-14));
    }
    // A plane plate never does: what came in goes out.
    const RayTracer plate(lens, LightDirection::to_film);
    for (double angle = 0; angle < 1.5; angle += 0.1) {
        const TracedRay ray = plate({0, 0, 0}, {std::sin(angle), 0, std::cos(angle)});
        REQUIRE(ray.passed());
        CHECK(std::fabs(ray.direction.x - std::sin(angle)) < 1e-14);
    }
}

TEST_CASE("a hole and a rim block where they should, to the last digits") {
    Surface obstruction;
    obstruction.type = SurfaceType::aperture;
    obstruction.clear_semi_diameter = 10;
    obstruction.inner_semi_diameter = 4;
    const LensSystem lens = lens_of({obstruction, stop_plane(0, 20)});
    const RayTracer trace(lens, LightDirection::to_film);
    for (const double azimuth : {0.0, 1.0, 4.0}) {
        const auto status = [&](double r) {
            return trace({r * std::cos(azimuth), r * std::sin(azimuth), -3}, {0, 0, 1}).status;
        };
        CHECK(status(0) == RayStatus::vignetted);
        CHECK(status(4 - 1e-12) == RayStatus::vignetted);
        CHECK(status(4 + 1e-12) == RayStatus::ok);
        CHECK(status(10 - 1e-12) == RayStatus::ok);
        CHECK(status(10 + 1e-12) == RayStatus::vignetted);
    }
}

TEST_CASE("rays that are not ok on entry stay as they are, and disturb no other lane") {
    const LensSystem lens = io::read_lens("phone-4mm");  // aspheres and planes
    const LensPath<double> path(lens, LightDirection::to_scene, lens.wavelength_nm);
    constexpr int N = 8;
    LensRays<double, N> rays, alone;
    PathRecord<double, N> record{}, record_alone{};
    const std::vector<Vec3d> bad = {{kNaN, 0, 0}, {kInfinity, 1, 1}, {0, 0, 0}, {0, kNaN, kNaN}};
    for (int i = 0; i < N; ++i) {
        const Vec3d origin{0.01 * i, 0.02, lens.film_distance}, direction = normalized(Vec3d{0.01 * i, 0, -1});
        const bool is_bad = i % 2 == 1;
        rays.origin.set(i, is_bad ? bad[static_cast<std::size_t>(i / 2)] : origin);
        rays.direction.set(i, is_bad ? bad[static_cast<std::size_t>(3 - i / 2)] : direction);
        rays.status[i] = is_bad ? static_cast<int>(RayStatus::bad_input) : 0;
        record.surface_index[i] = -1;
        alone.origin.set(i, origin);
        alone.direction.set(i, direction);
        alone.status[i] = 0;
    }
    trace_lens(path.view(), rays, record);
    trace_lens(path.view(), alone, record_alone);
    for (int i = 0; i < N; ++i) {
        if (i % 2 == 1) {
            CHECK(rays.status[i] == static_cast<int>(RayStatus::bad_input));
            CHECK(record.surface_index[i] == -1);
            CHECK(record.optical_path[i] == 0);
            const Vec3d given = bad[static_cast<std::size_t>(3 - i / 2)], kept = rays.direction[i];
            CHECK((std::isnan(given.x) ? std::isnan(kept.x) : given.x == kept.x));
            CHECK((std::isnan(given.y) ? std::isnan(kept.y) : given.y == kept.y));
        } else {
            CHECK(rays.status[i] == 0);
            CHECK(length(rays.origin[i] - alone.origin[i]) == 0);
            CHECK(length(rays.direction[i] - alone.direction[i]) == 0);
            CHECK(record.optical_path[i] == record_alone.optical_path[i]);
        }
    }
}
