// Rays for which the search on an asphere needs no bracket: they must cross the asphere once, whatever their origin.

#include <algorithm>
#include <cmath>

#include "doctest/doctest.h"
#include "traced_ray.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

/// Gull wings, walls at the rim, hyperboloids and nearly plane ones: each term lifts the rim by up to `lift` of it.
Surface wavy_asphere(Random& random) {
    const double rim = random.between(1, 10), lift = std::pow(10.0, random.between(-3, -0.3));
    Surface surface =
        refracting(rim * random.between(1.05, 20) * (random() < 0.5 ? -1 : 1), 0, Glass::constant(1.5), rim);
    surface.conic = random() < 0.5 ? random.between(-20, -1) : random.between(-1, 0);
    for (int i = 0; i < kMaxAsphericTerms; ++i)
        surface.aspheric.push_back(random.between(-lift, lift) * std::pow(rim, -3 - 2 * i));
    return surface;
}

/// Number of sign changes, along the whole ray, of its height above the surface, which is extended by a plane outside
/// the search radius.
int sign_changes(const SurfaceView<double>& surface, Vec3d o, Vec3d p) {
    const double reach = std::sqrt(surface.search_squared), margin = surface.sag_max - surface.sag_min + reach;
    constexpr int kSteps = 4000;
    int changes = 0;
    double before = 0;
    for (int i = 0; i <= kSteps; ++i) {
        const double z = surface.sag_min - margin + (surface.sag_max - surface.sag_min + 2 * margin) * i / kSteps;
        const Vec3d at = o + ((z - o.z) / p.z) * p;
        const double height = z - asphere_sag(surface, at.x * at.x + at.y * at.y).height;
        changes += static_cast<int>(i > 0 && (height > 0) != (before > 0));
        before = height;
    }
    return changes;
}

bool said_to_cross_once(const SurfaceView<double>& surface, Vec3d o, Vec3d p) {
    return crosses_once(surface, height_ray(surface, o, p));
}

}  // namespace

TEST_CASE("no place of an asphere is steeper than its bound, which is not far above the steepest") {
    Random random(3);
    for (int trial = 0; trial < 200; ++trial) {
        const Surface wavy = wavy_asphere(random);
        const LensPath<double> path(lens_of({wavy}), LightDirection::to_film, kLineD_nm);
        const SurfaceView<double>& surface = path.view().surfaces[0];
        const double reach = std::sqrt(surface.search_squared);
        std::vector<long double> terms;
        for (std::size_t i = 0; i < wavy.aspheric.size(); ++i)
            terms.push_back(wavy.aspheric[i] * std::pow(reach, 4 + 2 * static_cast<double>(i)));
        for (const double share : {0.5, 1.0}) {
            double steepest = 0;
            for (int i = 1; i < 5000; ++i) {
                const double r = share * reach * i / 5000;
                steepest = std::max(steepest, std::fabs(2 * r * asphere_sag(surface, r * r).derivative));
            }
            const double bound = steepest_slope(surface, terms, share);
            CHECK(steepest <= bound * (1 + 1e-12));
            // Steps of 1/1024 of the radius, over which a power of r up to the 17th changes by 2%; terms of both signs
            // may each be a few times the slope that they leave.
            CHECK(bound < 1.3 * steepest + 0.02);
        }
    }
}

TEST_CASE("a surface that stands on end has no steepest slope, and all its rays are bracketed near the rim") {
    Surface surface = refracting(10, 0, Glass::constant(1.5), 10);
    surface.aspheric = {1e-9};
    const LensPath<double> path(lens_of({surface}), LightDirection::to_film, kLineD_nm);
    CHECK(path.view().surfaces[0].crossed_once < 1e-9);
    CHECK(path.view().surfaces[0].crossed_once_inside > 0);
}

TEST_CASE("rays that are said to cross an asphere once do, from either side, and many others do not") {
    Random random(7);
    int once = 0, more = 0;
    for (int trial = 0; trial < 150; ++trial) {
        const auto way = trial % 2 ? LightDirection::to_film : LightDirection::to_scene;
        const LensPath<double> path(lens_of({wavy_asphere(random)}), way, kLineD_nm);
        SurfaceView<double> surface = path.view().surfaces[0];
        surface.shift = 0;
        const double reach = std::sqrt(surface.search_squared);
        for (int i = 0; i < 40; ++i) {
            const Vec3d target{random.between(-reach, reach), random.between(-reach, reach), 0};
            const Vec3d p = normalized(Vec3d{random.between(-3, 3), random.between(-3, 3), surface.direction_sign_in});
            const Vec3d o = target - random.between(0, 3) * reach * p;
            const int changes = sign_changes(surface, o, p);
            CHECK_FALSE(said_to_cross_once(surface, o, -p));
            more += static_cast<int>(changes > 1);
            if (!said_to_cross_once(surface, o, p)) continue;
            ++once;
            CHECK(changes == 1);
        }
    }
    CHECK(once > 1000);
    CHECK(more > 100);
}

TEST_CASE("rays along the vertex plane, tangents, and what is no ray are left to the bracketed search") {
    Surface surface = refracting(1e6, 0, Glass::constant(1.5), 5);
    surface.aspheric = {1e-9};
    const LensPath<double> path(lens_of({surface}), LightDirection::to_film, kLineD_nm);
    const SurfaceView<double>& flat = path.view().surfaces[0];
    const double most = std::numeric_limits<double>::max(), nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(said_to_cross_once(flat, {1, 0, -1}, {0.9, 0, 0.1}));
    CHECK_FALSE(said_to_cross_once(flat, {-20, 0, -0.5}, {1, 0, 0.04}));
    for (const Vec3d p : {Vec3d{1, 0, 0}, Vec3d{0, 0, 0}, Vec3d{0, most, most}, Vec3d{nan, 0, 1}, Vec3d{0, 0, nan}})
        CHECK_FALSE(said_to_cross_once(flat, {0, 0, -1}, p));
}

TEST_CASE("nearly all rays through a phone lens need no bracket") {
    const LensSystem lens = io::read_lens("phone-4mm");
    const LensPath<float> path(lens, LightDirection::to_film, lens.wavelength_nm);
    Random random(9);
    int rays = 0, bracketed = 0;
    for (int i = 0; i < 2000; ++i) {
        const double r = std::sqrt(random()), azimuth = random.between(0, 2 * M_PI);
        LensRays<float, 1> ray;
        ray.origin.set(0, static_cast<Vec3f>(Vec3d{r * std::cos(azimuth), r * std::sin(azimuth), 0}));
        ray.direction.set(0, static_cast<Vec3f>(normalized(Vec3d{random.between(-0.7, 0.7), 0, 1})));
        ray.status[0] = 0;
        for (int k = 0; k < path.view().count && ray.status[0] == 0; ++k) {
            const SurfaceView<float>& surface = path.view().surfaces[k];
            const LensRays<float, 1> before = ray;
            trace_lens(LensView<float>{&surface, 1, LensKind::rotational, {}}, ray);
            if (surface.kind != SurfaceShape::asphere || ray.status[0] != 0) continue;
            LensRays<float, 1> here = before;
            here.origin.z[0] -= surface.shift;
            AsphereHits<float, 1> hits;
            ++rays;
            bracketed += find_single_crossings(surface, here, hits);
        }
    }
    CHECK(rays > 10000);
    CHECK(bracketed < rays / 100);
}
