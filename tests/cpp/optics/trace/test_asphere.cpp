// Even aspheres whose terms nearly cancel. tests/truth, test_hard_surfaces.cpp and tests/fuzz have the laws of all.

#include <cmath>
#include <limits>
#include <vector>

#include "about.hpp"
#include "doctest/doctest.h"
#include "embree/kernels.hpp"
#include "optics/trace/trace_request.hpp"
#include "optics/trace_backends.hpp"
#include "traced_ray.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

// Rays from in front that cross the vertex plane inside the rim, under up to 40 degrees.
template <class Check>
void for_random_rays(const Surface& s, int count, Check&& check) {
    Random random(11);
    const double rim = s.clear_semi_diameter;
    for (int i = 0; i < count; ++i) {
        const Vec3d target{random.between(-rim, rim), random.between(-rim, rim), 0};
        const Vec3d slant{random.between(-0.6, 0.6), random.between(-0.6, 0.6), 1};
        check(target - 1.5 * rim * slant, normalized(slant));
    }
}

}  // namespace

// The terms in powers of r^2 have magnitudes of up to 1700 mm in total, and add up to 4 mm. test_bundled_rays.cpp
// compares the rays with 50 digits.
TEST_CASE("no ray is lost where the terms of an asphere are hundreds of times as large as their sum") {
    const LensSystem phone = io::read_lens("phone-4mm-seven-elements");
    for (const TraceBackend& backend : trace_backends()) {
        CAPTURE(backend.name);
        CAPTURE(backend.number_type());
        int passed = 0, lost = 0;
        for (const Surface& surface : phone.surfaces) {
            if (!surface.is_asphere()) continue;
            RayBatch rays;
            for_random_rays(surface, 20000, [&](Vec3d o, Vec3d d) { rays.add(o, d); });
            for (const int status : backend(lens_of({surface}), LightDirection::to_film, rays).status) {
                passed += static_cast<int>(status == static_cast<int>(RayStatus::ok));
                lost += static_cast<int>(status == static_cast<int>(RayStatus::no_convergence));
            }
        }
        CHECK(passed > 200000);
        CHECK(lost == 0);
    }
}

TEST_CASE("every power of the polynomial counts, up to r^18") {
    for (int term = 0; term < kMaxAsphericTerms; ++term) {
        CAPTURE(4 + 2 * term);
        Surface surface = refracting(40, 0, Glass::constant(1.5), 2);
        surface.aspheric.assign(static_cast<std::size_t>(term) + 1, 0.0);
        surface.aspheric.back() = 0.3 * std::pow(2.0, -(4 + 2 * term));  // 0.3 mm at the rim
        const RayTracer trace(lens_of({surface}), LightDirection::to_film);
        for (const double r : {0.5, 1.0, 1.7, 1.95}) {
            const TracedRay ray = trace({0, r, -1}, {0, 0, 1});
            REQUIRE(ray.passed());
            const double z =
                0.025 * r * r / (1 + std::sqrt(1 - 0.025 * 0.025 * r * r)) + 0.3 * std::pow(r / 2, 4 + 2 * term);
            CHECK(ray.origin.z == about(z, 1e-13));
            CHECK(surface.sag(r) == about(z, 1e-13));
        }
    }
}

namespace {

/// An asphere in air for rays towards the scene, without its polynomial and bounds, which the caller sets.
SurfaceView<float> asphere_in_air(float curvature) {
    SurfaceView<float> step{};
    step.kind = SurfaceShape::asphere;
    step.curvature = curvature;
    step.conic_factor = 1;
    step.direction_sign_in = step.direction_sign_out = -1;
    step.index_squared = 1;
    step.hole_squared = -1;
    return step;
}

}  // namespace

TEST_CASE("a guess that is a root to the last digit, but in the wrong direction, does not end the search") {
    // Found by fuzzing: at its intersection with the base sphere, the ray grazes the asphere from the other side.
    SurfaceView<float> step = asphere_in_air(-0.000786048942245543f);
    step.rim_squared = 460218.562f;
    step.sag_min = -143.261475f;
    step.sag_max = 3.48744249f;
    step.sag_edge = -84.1429596f;
    step.search_squared = 478811.406f;
    step.inverse_search_squared = 2.08850497e-06f;
    set_terms(step, {0, 0, 0.146389484, 4.4322176, 0, 0, 115.922592});
    const Vec3f o{-42.1688385f, -413.224945f, -69.6575089f}, p{1.249142050743103f, -1.3547871112823486f, -0.42072546f};

    LensRays<float, 1> ray;
    ray.origin.set(0, o);
    ray.direction.set(0, p);
    ray.status[0] = 0;
    trace_lens(LensView<float>{&step, 1, LensKind::rotational, {}}, ray, PathRecord<float, 1>{});
    const Vec3f at = ray.origin[0];
    CHECK(ray.status[0] != static_cast<int>(RayStatus::no_convergence));
    CHECK(std::fabs(at.z - asphere_sag(step, at.x * at.x + at.y * at.y).height) < 1e-3f);
    const float slope = asphere_sag(step, at.x * at.x + at.y * at.y).derivative;
    CHECK(p.z - 2 * slope * (at.x * p.x + at.y * p.y) < 0);
}

TEST_CASE("a sphere and a polynomial that nearly cancel leave roundings that the search puts up with") {
    // Found by fuzzing: heights of -57 and +59 mm, whose sum is 1.9 mm. With fused products the search did not end.
    SurfaceView<float> step = asphere_in_air(-0.008210781f);
    step.rim_squared = step.search_squared = 14833.0703f;
    step.inverse_search_squared = 6.74169278e-05f;
    step.sag_min = -16.6744919f;
    step.sag_max = 2.37656426f;
    step.sag_edge = -16.1910191f;
    set_terms(step, {104.430878, 2.45804821e-09, -0.000356839882, 0.171949089, 0.0698637888, 0.927728653});
    const double origin[] = {-84.215385437011719, -78.606109619140625, 2.9163384437561035};
    const double direction[] = {-0.92613470554351807, 0.35610920190811157, -1.1238919496536255};
    const double index = std::sqrt(0.92613470554351807 * 0.92613470554351807 +
                                   0.35610920190811157 * 0.35610920190811157 + 1.1238919496536255 * 1.1238919496536255);
    for (const realcam_kernels* kernels : available_kernels()) {
        double at[3], towards[3], path;
        int status, surface;
        const TraceRequest<float> request{{&step, 1, LensKind::rotational, {}},
                                          0,
                                          0,
                                          index,
                                          1e9,
                                          1,
                                          origin,
                                          direction,
                                          at,
                                          towards,
                                          &path,
                                          &status,
                                          &surface};
        kernels->trace_f32(&request);
        CAPTURE(kernels->instruction_set);
        CHECK(status != static_cast<int>(RayStatus::no_convergence));
        const auto r2 = static_cast<float>(at[0] * at[0] + at[1] * at[1]);
        // Four roundings of each of the two heights.
        CHECK(std::fabs(at[2] - static_cast<double>(asphere_sag(step, r2).height)) < 8 * 59 * 1.2e-7);
    }
}
