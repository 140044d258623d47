// Surfaces that are tilted and decentred: what their frames are, and closed forms of what they do to light.

#include <cmath>
#include <numbers>

#include "about.hpp"
#include "doctest/doctest.h"
#include "optics/lens/lens_changes.hpp"
#include "optics/lens/lens_edits.hpp"
#include "optics/prescription/lens_system.hpp"
#include "refusal.hpp"
#include "traced_ray.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

Surface placed(Surface surface, Vec3d decentre, Vec3d tilt_deg, bool returns = false) {
    surface.placement = {decentre, tilt_deg, returns};
    return surface;
}

Surface plane_mirror(double thickness, double semi_diameter) {
    Surface s = refracting(0, thickness, Glass::air(), semi_diameter);
    s.type = SurfaceType::mirror;
    return s;
}

double angle_between(Vec3d a, Vec3d b) {
    return std::atan2(length(cross(a, b)), dot(a, b));
}

}  // namespace

TEST_CASE("a placement turns about x, then the new y, then the new z, counterclockwise from the tip of the axis") {
    const auto frame = [](Vec3d tilt) { return SurfacePlacement{{1, 2, 3}, tilt, false}.frame(); };
    CHECK(frame({90, 0, 0}).z == Vec3d{0, -1, 0});
    CHECK(frame({0, 90, 0}).z == Vec3d{1, 0, 0});
    CHECK(frame({0, 0, 90}).x == Vec3d{0, 1, 0});
    CHECK(frame({90, 90, 0}).x == Vec3d{0, 1, 0});
    CHECK(frame({90, 90, 0}).z == Vec3d{1, 0, 0});
    CHECK(frame({30, 0, 0}).z.y == about(-0.5, 1e-15));
    CHECK(frame({30, 40, 50}).origin == Vec3d{1, 2, 3});
}

TEST_CASE("a placement is found again from its frame, also where two of its axes are one") {
    for (const Vec3d tilt : {Vec3d{10, 20, 30}, Vec3d{-170, 60, 135}, Vec3d{25, 90, 40}, Vec3d{25, -90, 40},
                             Vec3d{90, 0, 180}, Vec3d{0, 0, 0}, Vec3d{0, 180, 0}}) {
        CAPTURE(tilt.x);
        CAPTURE(tilt.y);
        const Affine<double> frame = SurfacePlacement{{1, -2, 3}, tilt, false}.frame();
        const Affine<double> again = SurfacePlacement::from_frame(frame).frame();
        for (const auto axis : {&Affine<double>::x, &Affine<double>::y, &Affine<double>::z})
            CHECK(length(frame.*axis - again.*axis) < 1e-14);
        CHECK(again.origin == frame.origin);
        const Affine<double> back = inverse_motion(frame) * frame;
        CHECK(length(back.origin) < 1e-14);
        CHECK(length(back.z - Vec3d{0, 0, 1}) < 1e-15);
    }
}

TEST_CASE("a plane mirror at 45 degrees turns light by 90 degrees, and the axis goes on with it") {
    LensSystem lens = lens_of({stop_plane(10, 5), placed(plane_mirror(0, 8), {0, 0, 0}, {45, 0, 0}),
                               placed(stop_plane(0, 5), {0, 0, 0}, {45, 0, 0})});
    lens.surfaces[1].thickness = 0;
    lens.surfaces[2].type = SurfaceType::aperture;
    const TracedRay ray = RayTracer(lens, LightDirection::to_film)({0.5, 1, -3}, {0, 0, 1});
    REQUIRE(ray.passed());
    // The normal is (0, -1, 1) / sqrt(2): light along z goes to +y.
    CHECK(length(ray.direction - Vec3d{0, 1, 0}) < 1e-15);
    CHECK(ray.origin.x == 0.5);
    CHECK(std::fabs(ray.origin.y) < 1e-14);  // back on the plane across the new axis, 1 mm before the mirror
    CHECK(ray.origin.z == about(11, 1e-14));
    CHECK(ray.optical_path == about(13, 1e-14));
}

TEST_CASE("a prism at minimum deviation deviates by 2 asin(n sin(a/2)) - a") {
    const double n = 1.5168, apex = 60;
    // Both faces lean by half of the apex angle; the light comes in at the angle of minimum deviation.
    LensSystem lens =
        lens_of({placed(refracting(0, 10, Glass::constant(n), 40), {0, 0, 0}, {apex / 2, 0, 0}, true),
                 placed(refracting(0, 0, Glass::air(), 40), {0, 0, 0}, {-apex / 2, 0, 0}, true), stop_plane(0, 100)});
    lens.allow_overlap = true;
    const double incidence = std::asin(n * std::sin(apex / 2 * kDegree));
    // The normal of the first face is (0, -sin 30, cos 30); inside, the light goes along z.
    const double lean = incidence - apex / 2 * kDegree;
    const Vec3d towards{0, std::sin(lean), std::cos(lean)};
    const TracedRay ray = RayTracer(lens, LightDirection::to_film)(Vec3d{0, 0, 0} - 30.0 * towards, towards);
    REQUIRE(ray.passed());
    CHECK(angle_between(ray.direction, towards) == about(2 * incidence - apex * kDegree, 1e-14));
}

TEST_CASE("every moved element leaves what is in its place in place") {
    LensSystem lens =
        lens_of({refracting(50, 4, Glass::constant(1.6), 10), refracting(-80, 6, Glass::air(), 10), stop_plane(3, 5),
                 refracting(-40, 2, Glass::constant(1.7), 8), refracting(60, 5, Glass::air(), 8),
                 refracting(90, 3, Glass::constant(1.5), 9), refracting(0, 0, Glass::air(), 9)});
    const SurfaceFrames before = surface_frames(lens);
    const Affine<double> moved = SurfacePlacement{{0.3, -0.2, 0.1}, {5, -7, 11}, false}.frame();
    for (const auto& [first, last] : {std::pair{0, 1}, {3, 4}, {5, 6}, {2, 2}, {6, 6}, {0, 6}}) {
        CAPTURE(first);
        CAPTURE(last);
        const LensSystem tilted = with_element_tilted(lens, first, last, {{0.3, -0.2, 0.1}, {5, -7, 11}, false}, 2.5);
        const SurfaceFrames after = surface_frames(tilted);
        const Affine<double> pivot{{1, 0, 0},
                                   {0, 1, 0},
                                   {0, 0, 1},
                                   before.surfaces[static_cast<std::size_t>(first)].origin + Vec3d{0, 0, 2.5}};
        for (int i = 0; i < 7; ++i) {
            const auto k = static_cast<std::size_t>(i);
            const bool is_moved = i >= first && i <= last;
            const Affine<double> wanted =
                is_moved ? pivot * moved * inverse_motion(pivot) * before.surfaces[k] : before.surfaces[k];
            CHECK(length(after.surfaces[k].origin - wanted.origin) < 1e-13);
            CHECK(length(after.surfaces[k].z - wanted.z) < 1e-14);
            CHECK(length(after.surfaces[k].x - wanted.x) < 1e-14);
        }
        CHECK(length(after.last_axis.origin - before.last_axis.origin) < 1e-13);
        CHECK(length(after.last_axis.z - before.last_axis.z) < 1e-14);
    }
}

TEST_CASE("rays enter and leave in the frames that are asked for") {
    LensSystem lens = lens_of({placed(refracting(50, 4, Glass::constant(1.6), 15), {1, 2, 0}, {10, 20, 0}),
                               refracting(-80, 0, Glass::air(), 15), stop_plane(3, 20)});
    lens.surfaces[1].thickness = 5;
    const SurfaceFrames frames = surface_frames(lens);
    const Affine<double> entry = SurfacePlacement{{3, 1, -20}, {5, 0, 0}, false}.frame();
    const auto trace = [&](const PathEnds& ends, Vec3d origin, Vec3d direction) {
        const LensPath<double> path(lens, LightDirection::to_film, lens.wavelength_nm, ends);
        LensRays<double, 1> ray;
        ray.origin.set(0, origin - Vec3d{0, 0, path.entry_position});
        ray.direction.set(0, direction);
        ray.status[0] = 0;
        trace_lens(path.view(), ray);
        CHECK(ray.status[0] == 0);
        return std::pair(ray.origin[0] + Vec3d{0, 0, path.exit_position}, ray.direction[0]);
    };
    const Vec3d origin{0.5, 0.25, 1}, direction = normalized(Vec3d{-0.05, 0.02, 1});
    const auto [at, way] = trace({}, entry.point(origin), entry.direction(direction));
    const auto [film_at, film_way] = trace({entry, frames.last_axis}, origin, direction);
    CHECK(length(frames.last_axis.point(film_at) - at) < 1e-13);
    CHECK(length(frames.last_axis.direction(film_way) - way) < 1e-14);
}

TEST_CASE("hard places: edge on, decentred beyond the rim, looking back") {
    // Edge on, light along the axis runs in the plane.
    LensSystem edge_on =
        lens_of({stop_plane(10, 5), placed(refracting(0, 0, Glass::constant(1.5), 5), {0, 0, 0}, {90, 0, 0}, true)});
    const TracedRay along = RayTracer(edge_on, LightDirection::to_film)({0, 1, -1}, {0, 0, 1});
    CHECK(along.status == RayStatus::missed);
    CHECK(along.surface_index == 1);
    // Beyond its rim.
    LensSystem beside =
        lens_of({stop_plane(10, 5), placed(refracting(30, 0, Glass::constant(1.5), 4), {20, 0, 0}, {0, 0, 0}, true)});
    CHECK(RayTracer(beside, LightDirection::to_film)({0, 0, -1}, {0, 0, 1}).status == RayStatus::vignetted);
    // A surface turned round is the surface of the opposite curvature.
    const LensSystem plain =
        lens_of({stop_plane(10, 5), refracting(30, 2, Glass::constant(1.5), 8), refracting(0, 0, Glass::air(), 8)});
    LensSystem turned = plain;
    turned.surfaces[1] = placed(refracting(-30, 2, Glass::constant(1.5), 8), {0, 0, 0}, {0, 180, 0}, true);
    const Vec3d from{1, 2, -3}, towards = normalized(Vec3d{0.1, -0.05, 1});
    const TracedRay a = RayTracer(plain, LightDirection::to_film)(from, towards),
                    b = RayTracer(turned, LightDirection::to_film)(from, towards);
    REQUIRE(a.passed());
    REQUIRE(b.passed());
    CHECK(length(a.origin - b.origin) < 1e-13);
    CHECK(length(a.direction - b.direction) < 1e-14);
}

TEST_CASE("what needs an axis of revolution says which surface has none") {
    LensSystem lens =
        lens_of({refracting(50, 4, Glass::constant(1.6), 15), refracting(-80, 5, Glass::air(), 15), stop_plane(0, 5)});
    CHECK(lens.is_rotational());
    lens.surfaces[1].placement.tilt_deg.x = 1;
    CHECK_FALSE(lens.is_rotational());
    CHECK(message_of([&] { trace_paraxial(lens, lens.wavelength_nm, {1, 0}, 0, 3); }) ==
          "first-order data needs a rotationally symmetric lens; surface 2 is tilted");
    CHECK(message_of([&] { reversed(lens); }) ==
          "turning a lens round needs a rotationally symmetric lens; surface 2 is tilted");
    lens.surfaces[1].placement = {{0, 1e10, 0}, {0, 0, 0}, false};
    CHECK(message_of<LensFileError>([&] { validate(lens); }) ==
          "surface 2: the decentre must be three lengths of at most 1e9 mm");
    lens.surfaces[1].placement = {{0, 0, 0}, {0, 400, 0}, false};
    CHECK(message_of<LensFileError>([&] { validate(lens); }) ==
          "surface 2: the tilt must be three angles between -360 and 360 degrees");
}
