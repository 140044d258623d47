// Superconics: against the surface's equation in 50 digits, a Cartesian oval's two foci, and a conic.

#include <cmath>

#include "../oracle.hpp"
#include "about.hpp"
#include "doctest/doctest.h"
#include "io/lens/lens_toml.hpp"
#include "optics/derivatives/dual_surface.hpp"
#include "optics/prescription/lens_checks.hpp"
#include "optics/trace/traced_shape.hpp"
#include "refusal.hpp"
#include "traced_ray.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

constexpr double kRim = 10;

Surface superconic(double curvature, double conic, const std::vector<double>& coefficients) {
    Surface surface = refracting(1 / curvature, 0, Glass::constant(1.6), kRim);
    surface.conic = conic;
    surface.form.superconic = SuperconicTerms{8, coefficients};
    return surface;
}

std::vector<Surface> some_superconics() {
    return {superconic(1 / 40.0, -0.5, {0.02, -0.03, 0.01, 0.005}), superconic(-1 / 30.0, 0.3, {0.1, 0.05}),
            superconic(1 / 25.0, 0, {-0.3, 0.1, 0.05, -0.02, 0.01})};
}

/// Root of the surface's equation by bisection between the vertex plane and a sag that is too large.
Real exact_sag(const Surface& surface, double r) {
    const SuperconicTerms& terms = *surface.form.superconic;
    const Real radius = terms.radius, c = surface.curvature, k = surface.conic;
    const auto difference = [&](const Real& z) {
        const Real s2 = Real(r) * r + z * z, w = s2 / (radius * radius);
        Real u = 0, v = 0, power = 1;
        for (std::size_t i = 0; i < terms.coefficients.size(); ++i) {
            if (i % 2 == 0) power *= w;
            (i % 2 == 0 ? u : v) += terms.coefficients[i] * power;
        }
        return c * (s2 * (1 + u) + k * z * z + radius * z * v) - 2 * z;
    };
    Real low = 0, high = 2 * surface.sag(r);
    const bool rises = difference(low) < 0;
    for (int step = 0; step < 170; ++step) {
        const Real middle = (low + high) / 2;
        ((difference(middle) < 0) == rises ? low : high) = middle;
    }
    return low;
}

/// Sag of the polynomials by which the surface is traced.
double traced_sag(const Surface& surface, double x, double y) {
    const auto view = freeform_view<double>(surface);
    const Lanes<double, 1> at_x = {x}, at_y = {y};
    FreeformSags<double, 1> sags;
    freeform_sags<double, 1>(view, at_x, at_y, sags);
    return sags.height[0];
}

}  // namespace

TEST_CASE("a superconic's sag satisfies its equation, and so does what is traced") {
    for (const Surface& surface : some_superconics())
        for (const double r : {0.01, 0.5, 3.0, 6.5, 9.0, 10.0}) {
            const double exact = static_cast<double>(exact_sag(surface, r));
            CHECK(surface.sag(r) == about(exact, 1e-15));
            CHECK(surface.sag(0.6 * r, -0.8 * r) == about(exact, 1e-15));
            CHECK(traced_sag(surface, 0.6 * r, -0.8 * r) == about(exact, 1e-11));
        }
}

TEST_CASE("a superconic without terms is its conic, and turns and scales as a surface does") {
    const Surface plain = superconic(1 / 40.0, -0.5, {0, 0});
    CHECK(plain.form.adds_nothing());
    Surface surface = some_superconics().back(), turned = surface, scaled = surface;
    turned.curvature = -surface.curvature;
    turned.form = surface.form.negated();
    CHECK(turned.sag(7) == -surface.sag(7));
    scaled.curvature = surface.curvature / 3;
    scaled.form = surface.form.scaled(3);
    CHECK(scaled.sag(21) == about(3 * surface.sag(7), 1e-15));
    CHECK(surface.form.asymmetry().empty());
    CHECK(surface.vertex_curvature() == surface.curvature);
}

TEST_CASE("a Cartesian oval images one point in another") {
    // n l + n' l' = constant = n a + n' b for the points at -a and b. Squared twice this is an equation of s^2 and z,
    // which divided by its term s^2 is that of a superconic.
    const double a = 60, b = 45, n = 1, n2 = 1.6, sum = n * a + n2 * b;
    const double alpha = 2 * n2 * b * sum, beta = n2 * n2 - n * n, gamma = -2 * (n2 * n2 * b + n * n * a);
    const double divisor = 2 * alpha * beta - 4 * sum * sum * n2 * n2;
    const double radius = -0.5 * (2 * alpha * gamma + 8 * sum * sum * n2 * n2 * b) / divisor;
    Surface oval = superconic(1 / radius, gamma * gamma / divisor, {});
    const double unit = oval.form.superconic->radius;
    oval.form.superconic->coefficients = {beta * beta / divisor * unit * unit, 2 * beta * gamma / divisor * unit};
    const RayTracer trace(lens_of({oval}), LightDirection::to_film);
    Surface conic = oval;
    conic.form.superconic.reset();
    const RayTracer trace_conic(lens_of({conic}), LightDirection::to_film);
    for (const double slope : {0.02, 0.06, 0.1, 0.14}) {
        const Vec3d direction = normalized(Vec3d{0.6 * slope, 0.8 * slope, 1});
        const TracedRay ray = trace({0, 0, -a}, direction), other = trace_conic({0, 0, -a}, direction);
        REQUIRE(ray.passed());
        CHECK(std::hypot(ray.at(b).x, ray.at(b).y) < 1e-11);
        CHECK(std::hypot(other.at(b).x, other.at(b).y) > 1e-6);
    }
}

TEST_CASE("derivatives by a superconic's numbers are those of its equation") {
    const Surface surface = some_superconics().back();
    const int row = 2;
    const std::vector<LensVariable> variables = {{LensQuantity::curvature, 0},
                                                 {LensQuantity::conic, 0},
                                                 {LensQuantity::terms, 0, 1, 0, row},
                                                 {LensQuantity::terms, 0, 4, 0, row}};
    const LensSystem lens = lens_of({stop_plane(1, kRim), surface});
    for (LensVariable variable : variables) {
        variable.surface = 1;
        CHECK_NOTHROW(check_variables(lens, {variable}));
    }
    DualSurface dual(traced_shape<double>(surface).view, surface, variables);
    for (int lane = 0; lane < 4; ++lane) seed_shape(dual, surface, variables[static_cast<std::size_t>(lane)], lane);
    const double step = 1e-5;
    const auto changed = [&](int lane, double by) {
        Surface other = surface;
        if (lane == 0) other.curvature += 0.01 * by;
        if (lane == 1) other.conic += by;
        if (lane > 1) other.form.superconic->coefficients[lane == 2 ? 0 : 3] += by;
        return other;
    };
    for (const double r : {2.0, 5.0, 9.5}) {
        const Lanes<Dual8, 1> x = {Dual8(0.6 * r)}, y = {Dual8(0.8 * r)};
        FreeformSags<Dual8, 1> sags;
        freeform_sags<Dual8, 1>(dual.form.front(), x, y, sags);
        CHECK(sags.height[0].value == about(surface.sag(r), 1e-11));
        for (int lane = 0; lane < 4; ++lane) {
            const Surface more = changed(lane, step), less = changed(lane, -step);
            const Real width = lane == 0   ? Real(more.curvature) - less.curvature
                               : lane == 1 ? Real(more.conic) - less.conic
                                           : Real(more.form.superconic->coefficients[lane == 2 ? 0 : 3]) -
                                                 less.form.superconic->coefficients[lane == 2 ? 0 : 3];
            const Real slope = (exact_sag(more, r) - exact_sag(less, r)) / width;
            CHECK(sags.height[0].by[lane] == about(static_cast<double>(slope), 1e-8));
        }
    }
}

TEST_CASE("superconics are the same after a lens file, and those that cannot be traced are refused") {
    LensSystem lens = lens_of({some_superconics().front(), stop_plane(1, 5)});
    lens.surfaces[0].thickness = 3;
    lens.film_distance = 40;
    CHECK(io::parse_lens(io::lens_as_toml(lens), "probe.toml").surfaces[0].form == lens.surfaces[0].form);
    const auto refused = [](Surface surface, const std::string& why) {
        CHECK(contains(message_of<LensFileError>([&] { validate(lens_of({surface, stop_plane(1, 5)})); }), why));
    };
    Surface surface = some_superconics().front();
    surface.form.forbes = ForbesTerms{ForbesKind::con, 10, {0.1}};
    refused(surface, "has both superconic and Forbes terms");
    surface.form.forbes.reset();
    surface.form.base = BaseForm::toroid;
    refused(surface, "depart from a conic of revolution");
    refused(superconic(1 / 12.0, 0, {2, 0, 8, 0, -5}), "with which they are traced");
    refused(superconic(1 / 40.0, 0, std::vector<double>(21, 0.1)), "has more superconic terms than 20");
}
