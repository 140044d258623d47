// Even aspheres against an independent search in long double, and surfaces that no one should make.

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
using Real = long double;

// The sag by its definition: c r^2 / (1 + sqrt(1 - (1+k) c^2 r^2)) + sum of a_p r^p, p = 4, 6, ...
Real sag(const Surface& s, Real r) {
    const Real c = s.curvature, k = s.conic;
    Real z = c * r * r / (1 + std::sqrt(1 - (1 + k) * c * c * r * r));
    Real power = r * r;
    for (const double a : s.aspheric) z += a * (power *= r * r);
    return z;
}

struct FoundCrossing {
    Real x, y, z, nx, ny, nz;
    int count = 0;  // of crossings inside the rim
};

// All crossings of a ray inside the rim, by a scan of its whole length for changes of sign and bisection; the
// first is kept. The normal comes from central differences of the sag.
FoundCrossing first_crossing(const Surface& s, Vec3d o, Vec3d d) {
    const Real rim = s.clear_semi_diameter;
    const auto height = [&](Real t, Real& r) {
        const Real x = o.x + t * d.x, y = o.y + t * d.y;
        r = std::sqrt(x * x + y * y);
        return o.z + t * d.z - sag(s, r);
    };
    FoundCrossing found;
    constexpr int kSteps = 1000;
    const Real reach = 4 * rim;
    Real before = 0, r = 0;
    bool known = false;
    for (int i = 0; i <= kSteps; ++i) {
        const Real t = reach * i / kSteps, here = height(t, r);
        if (r > rim) {
            known = false;
            continue;
        }
        if (known && (here > 0) != (before > 0) && ++found.count == 1) {
            Real low = reach * (i - 1) / kSteps, high = t;
            for (int k = 0; k < 80; ++k) {
                const Real middle = (low + high) / 2;
                ((height(middle, r) > 0) == (here > 0) ? high : low) = middle;
            }
            const Real at = (low + high) / 2;
            height(at, r);
            const Real h = 1e-5L * rim;
            const Real slope = r > h ? (sag(s, r + h) - sag(s, r - h)) / (2 * h) : 0;
            const Real x = o.x + at * d.x, y = o.y + at * d.y, norm = std::sqrt(1 + slope * slope);
            const Real radial = r > 0 ? slope / r : 0;
            found = {x, y, o.z + at * d.z, -radial * x / norm, -radial * y / norm, 1 / norm, 1};
        }
        before = here;
        known = true;
    }
    return found;
}

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

/// `terms_mm`: of the largest polynomial in powers of r^2 - rim^2 / 2, about, added up at the rim without their signs.
void check_aspheres_of(const char* name, double terms_mm) {
    const LensSystem phone = io::read_lens(name);
    const std::vector<double> n = phone.indices(phone.wavelength_nm);
    for (std::size_t i = 0; i < phone.surfaces.size(); ++i) {
        Surface surface = phone.surfaces[i];
        if (!surface.is_asphere()) continue;
        CAPTURE(i + 1);
        const double before = 1,
                     after = n[i + 1] > 1 ? n[i + 1] : n[i];  // each surface alone, air in front of it
        surface.material = Glass::constant(after);
        const RayTracer trace(lens_of({surface}), LightDirection::to_film);
        int compared = 0;
        for_random_rays(surface, 200, [&](Vec3d o, Vec3d d) {
            const FoundCrossing truth = first_crossing(surface, o, d);
            if (truth.count != 1) return;  // none, or a ray that grazes and crosses it twice
            const Real cosine = std::fabs(truth.nx * d.x + truth.ny * d.y + truth.nz * d.z);
            const TracedRay ray = trace(o, d);
            if (std::hypot(truth.x, truth.y) > 0.999L * surface.clear_semi_diameter) return;
            REQUIRE(ray.passed());
            ++compared;
            // The search stops within 4 roundings of its lengths, a few mm, and of the terms, whose sum may be off by
            // as much. For a grazing ray, an axial error becomes a larger one along the surface.
            const Real tolerance = (1e-14L + 8 * std::numeric_limits<double>::epsilon() * terms_mm) / cosine;
            CHECK(std::fabs(ray.origin.x - truth.x) < tolerance);
            CHECK(std::fabs(ray.origin.y - truth.y) < tolerance);
            CHECK(std::fabs(ray.origin.z - truth.z) < tolerance);
            // n d x N is the same on both sides. Central differences over 1e-5 of the rim are right to 1e-9.
            const Vec3d normal{static_cast<double>(truth.nx), static_cast<double>(truth.ny),
                               static_cast<double>(truth.nz)};
            CHECK(length(before * cross(d, normal) - after * cross(ray.direction, normal)) < 1e-8);
            CHECK(length(ray.direction) == about(1, 1e-14));
        });
        CHECK(compared > 100);
    }
}

}  // namespace

TEST_CASE("rays meet the aspheres of the phone lens where an independent search does, and obey Snell's law there") {
    check_aspheres_of("phone-4mm", 6);
}

// The terms in powers of r^2 have magnitudes of up to 1700 mm in total there, and add up to 4 mm.
TEST_CASE("so they do where the terms of an asphere are hundreds of times as large as their sum, and none is lost") {
    check_aspheres_of("phone-4mm-seven-elements", 18);
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

TEST_CASE("an absurd asphere ends rays with a status, and lets none through that is not on it") {
    Random random(5);
    int passed = 0, ended = 0;
    for (int trial = 0; trial < 60; ++trial) {
        Surface surface = refracting(random.between(3, 50), 0, Glass::constant(1.5), random.between(1, 2.9));
        surface.conic = random.between(-20, 0);
        for (int i = 0; i < kMaxAsphericTerms; ++i)
            surface.aspheric.push_back(random.between(-20, 20) * std::pow(surface.clear_semi_diameter, -4 - 2 * i));
        const RayTracer trace(lens_of({surface}), LightDirection::to_film);
        for_random_rays(surface, 200, [&](Vec3d o, Vec3d d) {
            const TracedRay ray = trace(o, d);
            REQUIRE(std::isfinite(length(ray.origin)));
            REQUIRE(std::isfinite(length(ray.direction)));
            REQUIRE(std::isfinite(ray.optical_path));
            const int status = static_cast<int>(ray.status);
            REQUIRE(status >= static_cast<int>(RayStatus::ok));
            REQUIRE(status <= static_cast<int>(RayStatus::no_convergence));
            ++(ray.passed() ? passed : ended);
            if (!ray.passed()) return;
            const double r = std::hypot(ray.origin.x, ray.origin.y);
            CHECK(r <= surface.clear_semi_diameter * (1 + 1e-14));
            // Terms of up to 20 mm that nearly cancel; the sag is as steep as 300 here.
            CHECK(std::fabs(ray.origin.z - static_cast<double>(sag(surface, r))) < 1e-11);
            CHECK(length(ray.direction) == about(1, 1e-12));
        });
    }
    CHECK(passed > 1000);
    CHECK(ended > 1000);
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
