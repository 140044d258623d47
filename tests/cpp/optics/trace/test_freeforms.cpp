// Surfaces other than conics of revolution: closed forms, and the laws that hold for every hit.

#include <cmath>
#include <numbers>

#include "about.hpp"
#include "doctest/doctest.h"
#include "optics/lens/paraxial.hpp"
#include "optics/prescription/lens_checks.hpp"
#include "refusal.hpp"
#include "traced_ray.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

Surface with_form(Surface surface, const SurfaceForm& form) {
    surface.form = form;
    return surface;
}

SurfaceForm toroid(double radius_x) {
    SurfaceForm form;
    form.base = BaseForm::toroid;
    form.curvature_x = radius_x == 0 ? 0 : 1 / radius_x;
    return form;
}

SurfaceForm biconic(double radius_x, double conic_x) {
    SurfaceForm form;
    form.base = BaseForm::biconic;
    form.curvature_x = 1 / radius_x;
    form.conic_x = conic_x;
    return form;
}

LensSystem alone(const Surface& surface) {
    return lens_of({surface});
}

TracedRay meet(const Surface& surface, Vec3d from, Vec3d towards) {
    return RayTracer(alone(surface), LightDirection::to_film)(from, towards);
}

/// One surface of every kind of form, with large coefficients.
std::vector<Surface> some_freeforms() {
    std::vector<Surface> list;
    const auto add = [&](double radius, const SurfaceForm& form) {
        list.push_back(with_form(refracting(radius, 0, Glass::constant(1.6), 10), form));
    };
    add(40, toroid(-60));
    add(0, toroid(25));
    add(-30, toroid(0));
    add(35, biconic(-50, 2));
    SurfaceForm odd;
    odd.radial = {0.05, 1e-3, -2e-4, 0, 1e-6};
    add(60, odd);
    SurfaceForm xy;
    xy.xy = {{1, 0, 0.03}, {0, 3, -3e-4}, {2, 2, 5e-6}, {3, 1, -4e-6}};
    add(-70, xy);
    SurfaceForm zernike;
    zernike.zernike =
        ZernikeTerms{ZernikeOrder::noll, 11, {0, 0.1, -0.2, 0.05, 0.04, -0.06, 0.02, 0.01, 0, 0.03, 0.02}};
    add(80, zernike);
    SurfaceForm forbes;
    forbes.forbes = ForbesTerms{ForbesKind::bfs, 11, {0.1, -0.05, 0.02}};
    add(50, forbes);
    forbes.forbes->kind = ForbesKind::con;
    add(-50, forbes);
    list.back().conic = -0.7;
    return list;
}

}  // namespace

TEST_CASE("a toroid of equal radii is a sphere, and so is a biconic") {
    const Surface sphere = refracting(30, 0, Glass::constant(1.6), 12);
    Random random(1);
    for (int i = 0; i < 100; ++i) {
        const Vec3d from{20 * random() - 10, 20 * random() - 10, -20};
        const Vec3d towards = normalized(Vec3d{random() - 0.5, random() - 0.5, 2});
        const TracedRay wanted = meet(sphere, from, towards);
        for (const SurfaceForm& form : {toroid(30), biconic(30, 0)}) {
            const TracedRay ray = meet(with_form(sphere, form), from, towards);
            REQUIRE(ray.status == wanted.status);
            if (!wanted.passed()) continue;
            CHECK(length(ray.origin - wanted.origin) < 1e-13);
            CHECK(length(ray.direction - wanted.direction) < 1e-14);
        }
    }
}

TEST_CASE("a cylinder refracts across its axis as a circle, and along it as a plane") {
    const Surface across = with_form(refracting(0, 0, Glass::constant(1.5), 8), toroid(20));  // curved in x
    const Surface along = with_form(refracting(20, 0, Glass::constant(1.5), 8), toroid(0));   // curved in y
    const Surface circle = refracting(20, 0, Glass::constant(1.5), 8),
                  plane = refracting(0, 0, Glass::constant(1.5), 8);
    for (const double height : {-6.0, -2.5, 0.0, 3.0, 7.5}) {
        const Vec3d slope = normalized(Vec3d{0.1, 0, 1}), turned = normalized(Vec3d{0, 0.1, 1});
        CHECK(length(meet(across, {height, 0, -5}, slope).direction - meet(circle, {height, 0, -5}, slope).direction) <
              1e-14);
        CHECK(length(meet(along, {0, height, -5}, turned).direction - meet(circle, {0, height, -5}, turned).direction) <
              1e-14);
        CHECK(length(meet(across, {0, height, -5}, turned).direction - meet(plane, {0, height, -5}, turned).direction) <
              1e-14);
        CHECK(length(meet(along, {height, 0, -5}, slope).direction - meet(plane, {height, 0, -5}, slope).direction) <
              1e-14);
    }
}

TEST_CASE("a toroid's point lies on the torus, and its normal passes through the circle of centres") {
    const double section = 15, ring = 40;
    const Surface surface = with_form(refracting(section, 0, Glass::constant(1.5), 9), toroid(ring));
    Random random(2);
    for (int i = 0; i < 100; ++i) {
        const TracedRay ray = meet(surface, {10 * random() - 5, 10 * random() - 5, -4},
                                   normalized(Vec3d{random() - 0.5, random() - 0.5, 3}));
        REQUIRE(ray.passed());
        // About a line parallel to y through (0, 0, ring): a circle of the section's radius, whose middle lies section
        // before the vertex's distance from the line.
        const double from_line = std::hypot(ray.origin.x, ring - ray.origin.z);
        CHECK(std::hypot(from_line - (ring - section), ray.origin.y) == about(section, 1e-13));
    }
}

TEST_CASE("an ellipsoid's off-axis part images one focus in the other, also as a biconic") {
    // Semi-axes a along the axis and b across: foci at a -+ sqrt(a^2 - b^2) from the vertex.
    const double a = 100, b = 60, c = std::sqrt(a * a - b * b), radius = -b * b / a, conic = -c * c / (a * a);
    Surface mirror = refracting(radius, 0, Glass::air(), 58);
    mirror.type = SurfaceType::mirror;
    mirror.conic = conic;
    mirror.aperture_shape.kind = ApertureOutline::ellipse;
    mirror.aperture_shape.half = {10, 8};
    mirror.aperture_shape.offset = {30, -20};
    for (const bool is_freeform : {false, true}) {
        if (is_freeform) mirror.form = biconic(radius, conic);
        // The mirror's vertex is at z = 0 and its inside towards the scene: foci at -(a - c) and -(a + c).
        const RayTracer trace(lens_of({mirror}), LightDirection::to_film);
        const Vec3d focus{0, 0, -(a + c)}, other{0, 0, -(a - c)};
        int passed = 0;
        for (int i = -10; i <= 10; ++i)
            for (int j = -10; j <= 10; ++j) {
                const double x = 30 + i, y = -20 + j;
                const Vec3d on{x, y, mirror.sag(x, y)};
                const TracedRay ray = trace(focus, normalized(on - focus));
                const double inside = i * i / 100.0 + j * j / 64.0;
                if (std::fabs(inside - 1) < 1e-9) continue;
                REQUIRE(ray.passed() == (inside < 1));
                if (!ray.passed()) continue;
                ++passed;
                const Vec3d to_focus = other - ray.origin;
                CHECK(length(to_focus - dot(to_focus, ray.direction) * ray.direction) < 1e-11);
            }
        CHECK(passed > 200);
    }
}

TEST_CASE("Zernike terms are those that their tables print") {
    const auto at = [](ZernikeOrder order, int number, double x, double y) {
        ZernikeTerms terms{order, 1, std::vector<double>(static_cast<std::size_t>(number), 0.0)};
        terms.coefficients.back() = 1;
        double z = 0;
        for (const XyTerm& term : terms.as_xy()) z += term.coefficient * std::pow(x, term.x) * std::pow(y, term.y);
        return z;
    };
    const double x = 0.3, y = -0.7, r2 = x * x + y * y;
    const auto noll = [&](int number) { return at(ZernikeOrder::noll, number, x, y); };
    const auto fringe = [&](int number) { return at(ZernikeOrder::fringe, number, x, y); };
    // Noll 1976, table I.
    CHECK(noll(1) == about(1, 1e-14));
    CHECK(noll(2) == about(2 * x, 1e-14));
    CHECK(noll(3) == about(2 * y, 1e-14));
    CHECK(noll(4) == about(std::sqrt(3) * (2 * r2 - 1), 1e-13));
    CHECK(noll(5) == about(std::sqrt(6) * 2 * x * y, 1e-14));
    CHECK(noll(6) == about(std::sqrt(6) * (x * x - y * y), 1e-14));
    CHECK(noll(7) == about(std::sqrt(8) * (3 * r2 - 2) * y, 1e-13));
    CHECK(noll(8) == about(std::sqrt(8) * (3 * r2 - 2) * x, 1e-13));
    CHECK(noll(9) == about(std::sqrt(8) * (3 * x * x * y - y * y * y), 1e-13));
    CHECK(noll(10) == about(std::sqrt(8) * (x * x * x - 3 * x * y * y), 1e-13));
    CHECK(noll(11) == about(std::sqrt(5) * (6 * r2 * r2 - 6 * r2 + 1), 1e-12));
    // The list of the University of Arizona.
    CHECK(fringe(2) == about(x, 1e-14));
    CHECK(fringe(4) == about(2 * r2 - 1, 1e-13));
    CHECK(fringe(5) == about(x * x - y * y, 1e-14));
    CHECK(fringe(6) == about(2 * x * y, 1e-14));
    CHECK(fringe(7) == about((3 * r2 - 2) * x, 1e-13));
    CHECK(fringe(9) == about(6 * r2 * r2 - 6 * r2 + 1, 1e-12));
    CHECK(fringe(10) == about(x * x * x - 3 * x * y * y, 1e-13));
    CHECK(fringe(16) == about(20 * r2 * r2 * r2 - 30 * r2 * r2 + 12 * r2 - 1, 1e-12));
    CHECK(at(ZernikeOrder::fringe, 37, 1, 0) == about(1, 1e-10));
}

TEST_CASE("Forbes polynomials are those that he prints") {
    const auto at = [](ForbesKind kind, std::size_t m, double w) {
        ForbesTerms terms{kind, 1, std::vector<double>(m + 1, 0.0)};
        terms.coefficients.back() = 1;
        double sum = 0, power = 1;
        for (const double c : terms.in_powers()) sum += c * power, power *= 2 * w - 1;
        return sum;
    };
    const double w = 0.37;
    // Equations (A.1) to (A.4) of the paper of 2007.
    CHECK(at(ForbesKind::bfs, 0, w) == about(1, 1e-14));
    CHECK(at(ForbesKind::bfs, 1, w) == about((13 - 16 * w) / std::sqrt(19), 1e-14));
    CHECK(at(ForbesKind::bfs, 2, w) == about(std::sqrt(2.0 / 95) * (29 - 4 * w * (25 - 19 * w)), 1e-13));
    CHECK(at(ForbesKind::con, 0, w) == about(1, 1e-14));
    CHECK(at(ForbesKind::con, 1, w) == about(-(5 - 6 * w), 1e-13));
    CHECK(at(ForbesKind::con, 2, w) == about(15 - 14 * w * (3 - 2 * w), 1e-12));
}

TEST_CASE("terms of r^2 bend a surface at first order as its radius does") {
    Surface plain = refracting(50, 4, Glass::constant(1.6), 10), bent = plain, forbes = plain;
    plain.curvature += 2 * 1e-3;
    bent.form.radial = {0, 1e-3};
    forbes.form.forbes = ForbesTerms{ForbesKind::bfs, 10, {0.1}};
    const Surface back = refracting(-80, 0, Glass::air(), 10);
    const auto focal_length = [&](const Surface& first) {
        const LensSystem lens = lens_of({first, back, stop_plane(0, 5)});
        return first_order(lens, lens.wavelength_nm).effective_focal_length;
    };
    CHECK(focal_length(bent) == about(focal_length(plain), 1e-13));
    CHECK(forbes.vertex_curvature() == about(1 / 50.0 + 2 * 0.1 / 100, 1e-14));
    // A real ray near the axis has the same focal length.
    const double near = 1e-4;
    const LensSystem lens = lens_of({forbes, back, stop_plane(0, 5)});
    const TracedRay ray = RayTracer(lens, LightDirection::to_film)({0, near, -1}, {0, 0, 1});
    CHECK(ray.direction.y == about(-near / first_order(lens, lens.wavelength_nm).effective_focal_length, 1e-6));
}

TEST_CASE("every hit lies on the surface, obeys Snell's law and is the same back, for all kinds of number") {
    Random random(3);
    for (const Surface& surface : some_freeforms()) {
        const LensSystem lens = alone(surface);
        const RayTracer to_film(lens, LightDirection::to_film), to_scene(lens, LightDirection::to_scene);
        const LensPath<float> in_float(lens, LightDirection::to_film, lens.wavelength_nm);
        int passed = 0;
        for (int i = 0; i < 200; ++i) {
            const Vec3d from{20 * random() - 10, 20 * random() - 10, -12};
            const Vec3d towards = normalized(Vec3d{random() - 0.5, random() - 0.5, 1});
            const TracedRay there = to_film(from, towards);
            if (!there.passed()) continue;
            ++passed;
            const Vec3d at = there.origin;
            CHECK(at.z == doctest::Approx(surface.sag(at.x, at.y)).epsilon(1e-12));
            const double h = 1e-5;
            const Vec3d normal =
                normalized(Vec3d{(surface.sag(at.x - h, at.y) - surface.sag(at.x + h, at.y)) / (2 * h),
                                 (surface.sag(at.x, at.y - h) - surface.sag(at.x, at.y + h)) / (2 * h), 1});
            // The tangential part of n d stays; the normal is found by differences.
            CHECK(length(cross(1.6 * there.direction - towards, normal)) < 1e-8);
            const TracedRay back = to_scene(at + 3.0 * there.direction, -there.direction);
            REQUIRE(back.passed());
            CHECK(length(back.at(from.z) - from) < 1e-10);
            LensRays<float, 1> ray;
            ray.origin.set(0, static_cast<Vec3f>(from));
            ray.direction.set(0, static_cast<Vec3f>(towards));
            ray.status[0] = 0;
            trace_lens(in_float.view(), ray);
            // A few roundings of 20 mm; past the rim by one of them a ray may end.
            if (ray.status[0] == 0) CHECK(length(static_cast<Vec3d>(ray.origin[0]) - at) < 4e-5);
        }
        CHECK(passed > 60);
    }
}

TEST_CASE("a block of rays is traced as each of them alone") {
    constexpr int kRays = 64;
    Random random(4);
    for (const Surface& surface : some_freeforms()) {
        const LensPath<double> path(alone(surface), LightDirection::to_film, kLineD_nm);
        LensRays<double, kRays> block;
        for (int i = 0; i < kRays; ++i) {
            // Some run along the vertex plane, some go beside the surface, and some have ended.
            block.origin.set(i, {30 * random() - 15, 30 * random() - 15, -5});
            block.direction.set(i, normalized(Vec3d{random() - 0.5, random() - 0.5, i % 4 == 0 ? 0.02 : 0.6}));
            block.status[i] = i % 16 == 0 ? 2 : 0;
        }
        const LensRays<double, kRays> start = block;
        PathRecord<double, kRays> record{};
        trace_lens(path.view(), block, record);
        for (int i = 0; i < kRays; ++i) {
            LensRays<double, 1> one;
            one.origin.set(0, start.origin[i]);
            one.direction.set(0, start.direction[i]);
            one.status[0] = start.status[i];
            PathRecord<double, 1> alone_record{};
            trace_lens(path.view(), one, alone_record);
            CHECK(one.status[0] == block.status[i]);
            CHECK(length(one.origin[0] - block.origin[i]) < 1e-13);
        }
    }
}

TEST_CASE("a ray along the vertex plane meets what stands in its way") {
    // A valley along y, whose slopes are 2.5 mm high at x = -5 and 5.
    SurfaceForm form;
    form.xy = {{2, 0, 0.1}};
    const Surface valley = with_form(refracting(0, 0, Glass::constant(1.5), 10), form);
    // 1 mm over the plane it comes out of the scene's side of one slope, and goes back behind the other.
    const TracedRay along = meet(valley, {-5, 0, 1}, normalized(Vec3d{1, 0, 1e-6}));
    CHECK(along.passed());
    CHECK(along.origin.x == about(-std::sqrt(10), 1e-6));
    const TracedRay over = meet(valley, {0, 0, 20}, normalized(Vec3d{1, 0, 1e-6}));
    CHECK_FALSE(over.passed());
}

TEST_CASE("apertures and obscurations block what lies under them") {
    Surface window = refracting(0, 0, Glass::air(), 12);
    const auto passes = [&](double x, double y) { return meet(window, {x, y, -1}, {0, 0, 1}).passed(); };
    window.aperture_shape.kind = ApertureOutline::rectangle;
    window.aperture_shape.half = {3, 2};
    window.aperture_shape.offset = {1, -1};
    CHECK(passes(3.9, 0.9));
    CHECK_FALSE(passes(4.1, 0));
    CHECK_FALSE(passes(0, 1.1));
    CHECK(passes(-1.9, -2.9));
    window.aperture_shape = {};
    window.aperture_shape.kind = ApertureOutline::polygon;
    window.aperture_shape.corners = {{0, 0}, {6, 0}, {6, 6}, {3, 2}};  // hollow at (3, 2)
    CHECK(passes(5, 1));
    CHECK(passes(5.5, 5));
    CHECK_FALSE(passes(3, 3));
    CHECK_FALSE(passes(-1, 1));
    window.aperture_shape = {};
    window.aperture_shape.obscurations = spider_arms(3, 1, 12, 90);
    CHECK_FALSE(passes(0.4, 8));
    CHECK(passes(0.6, 8));
    CHECK(passes(0.4, -8));
    CHECK_FALSE(passes(8 * std::cos(M_PI / 6), -8 * 0.5));
    window.aperture_shape.obscurations = {{false, {2, 1}, {5, 0}, 90}};
    CHECK_FALSE(passes(5, 1.9));
    CHECK(passes(6.5, 0));
}

TEST_CASE("a form that cannot be is refused with the surface's number") {
    const auto refused = [](const Surface& surface) {
        LensSystem lens = lens_of({stop_plane(5, 5), surface, refracting(0, 0, Glass::air(), 10)});
        lens.allow_overlap = true;
        return message_of<LensFileError>([&] { validate(lens); });
    };
    const Surface plain = refracting(30, 3, Glass::constant(1.5), 10);
    CHECK(refused(with_form(plain, toroid(5))) ==
          "surface 2: does not extend over its whole clear aperture: its radii, conics or terms end it before");
    SurfaceForm form;
    form.xy = {{9, 6, 1e-9}};
    CHECK(contains(refused(with_form(plain, form)),
                   "the powers of terms of x and y must be at least 0, with a sum of at most 14"));
    form = {};
    form.curvature_x = 0.1;
    CHECK(contains(refused(with_form(plain, form)), "only a biconic or a toroid can have"));
    Surface window = plain;
    window.aperture_shape.kind = ApertureOutline::ellipse;
    window.aperture_shape.half = {3, 0};
    CHECK(contains(refused(window), "the half widths of its aperture must be positive lengths"));
    window.aperture_shape.half = {3, 3};
    window.aperture_shape.offset = {20, 0};
    CHECK(contains(refused(window), "its aperture lies beyond its clear semi-diameter"));
}

TEST_CASE("a rectangle may reach where the circle about it has no surface") {
    // The section ends at y = 10; the rectangle is 30 mm long in x.
    Surface surface = with_form(refracting(10, 0, Glass::constant(1.5), 31), toroid(0));
    surface.aperture_shape.kind = ApertureOutline::rectangle;
    surface.aperture_shape.half = {30, 7};
    const LensSystem lens = lens_of({stop_plane(5, 40), surface});
    CHECK_NOTHROW(validate(lens));
    const TracedRay ray = meet(surface, {29, 6, -3}, {0, 0, 1});
    REQUIRE(ray.passed());
    CHECK(ray.origin.z == about(10 - 8, 1e-13));
    CHECK_FALSE(meet(surface, {0, 8, -3}, {0, 0, 1}).passed());
}
