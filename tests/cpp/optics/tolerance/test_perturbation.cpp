// Perturbed lenses: what each perturbation changes, and nothing else. Truth: the definitions of the perturbations,
// and closed forms of prisms and plates.

#include "optics/tolerance/perturbation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "about.hpp"
#include "doctest/doctest.h"
#include "refusal.hpp"
#include "traced_ray.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

constexpr double kPrismIndex = 1.5;

LensSystem with_perturbation(const LensSystem& lens, Perturbation error, double size) {
    return perturbed(lens, {error}, {&size, 1});
}

/// A stop, and a glass plate 4 mm thick.
LensSystem plate() {
    LensSystem lens = lens_of(
        {stop_plane(2, 5), refracting(0, 4, Glass::constant(kPrismIndex), 10), refracting(0, 0, Glass::air(), 10)});
    lens.film_distance = 50;
    return lens;
}

/// A ray along the axis, behind a lens.
TracedRay axial_ray(const LensSystem& lens) {
    const TracedRay ray = RayTracer(lens, LightDirection::to_film)({0, 0, -1}, {0, 0, 1});
    REQUIRE(ray.passed());
    return ray;
}

/// By how much the rear face of a prism of this angle turns light that meets its front face at a right angle.
double prism_deviation(double angle) {
    return std::asin(kPrismIndex * std::sin(angle)) - angle;
}

}  // namespace

TEST_CASE("errors of no size leave the lens as it was drawn") {
    const LensSystem lens = io::read_lens("double-gauss-50mm");
    std::vector<Perturbation> errors;
    for (int kind = 0; kind <= static_cast<int>(PerturbationKind::irregularity_45); ++kind)
        errors.push_back({static_cast<PerturbationKind>(kind), 0, 1});
    LensSystem copy = perturbed(lens, errors, std::vector<double>(errors.size(), 0));
    CHECK(copy.allow_overlap);
    copy.allow_overlap = lens.allow_overlap;
    CHECK(copy == lens);
}

TEST_CASE("an error of the radius is one of mm, of percent, or of fringes of the sag at the rim") {
    const LensSystem lens = lens_of({stop_plane(1, 5), refracting(80, 0, Glass::constant(kPrismIndex), 10)});
    CHECK(1 / with_perturbation(lens, {PerturbationKind::radius, 1, 1}, -0.7).surfaces[1].curvature ==
          about(79.3, 1e-14));
    CHECK(1 / with_perturbation(lens, {PerturbationKind::radius_percent, 1, 1}, 2).surfaces[1].curvature ==
          about(81.6, 1e-14));
    for (const double radius : {80.0, 0.0}) {
        LensSystem drawn = lens;
        drawn.surfaces[1].curvature = radius == 0 ? 0 : 1 / radius;
        const LensSystem copy = with_perturbation(drawn, {PerturbationKind::radius_fringes, 1, 1}, 6);
        const double change = copy.surfaces[1].sag(10) - drawn.surfaces[1].sag(10);
        // Six half wavelengths of the parabola c r^2 / 2. The sag of a sphere changes with its curvature by
        // r^2 / (w (1 + w)), w the cosine of the slope; to a hundredth of the share by which the curvature changes,
        // 0.3%.
        const double w = std::sqrt(1 - std::pow(10 * drawn.surfaces[1].curvature, 2));
        CHECK(change == about(6 * 0.5 * 546.07e-6 * 2 / (w * (1 + w)), 1e-4));
    }
}

TEST_CASE("an error of the thickness moves what is behind, in each zoom position") {
    LensSystem lens = plate();
    CHECK(with_perturbation(lens, {PerturbationKind::thickness, 1, 1}, 0.3).last_vertex() == about(6.3, 1e-15));
    lens.zoom.surfaces = {1};
    lens.zoom.positions.resize(2);
    lens.zoom.positions[0].thicknesses = {4};
    lens.zoom.positions[1].thicknesses = {9};
    const LensSystem copy = with_perturbation(lens, {PerturbationKind::thickness, 1, 1}, 0.3);
    CHECK(copy.zoom.positions[0].thicknesses[0] == about(4.3, 1e-15));
    CHECK(copy.zoom.positions[1].thicknesses[0] == about(9.3, 1e-15));
}

TEST_CASE("irregularity is as many half wavelengths from valley to peak as asked for") {
    const LensSystem lens = lens_of({stop_plane(1, 5), refracting(80, 0, Glass::constant(kPrismIndex), 10)});
    for (const auto& [kind, peak] :
         {std::pair(PerturbationKind::irregularity_0, 0.0), {PerturbationKind::irregularity_45, 45.0}}) {
        const LensSystem copy = with_perturbation(lens, {kind, 1, 1}, 3);
        const auto off = [&](double azimuth_deg, double r) {
            const double x = r * std::cos(azimuth_deg * kDegree), y = r * std::sin(azimuth_deg * kDegree);
            return copy.surfaces[1].sag(x, y) - lens.surfaces[1].sag(r);
        };
        CHECK(off(peak, 10) - off(peak + 90, 10) == about(3 * 0.5 * 546.07e-6, 1e-9));
        CHECK(off(peak, 10) == about(-off(peak + 90, 10), 1e-9));
        CHECK(std::fabs(off(peak + 45, 10)) < 1e-15);
        CHECK(off(peak, 5) == about(off(peak, 10) / 4, 1e-9));
    }
}

TEST_CASE("a wedge turns light as a prism does") {
    for (const double angle_deg : {0.01, 0.5, 5.0}) {
        const TracedRay about_x =
            axial_ray(with_perturbation(plate(), {PerturbationKind::surface_tilt_x, 2, 2}, angle_deg));
        const TracedRay about_y =
            axial_ray(with_perturbation(plate(), {PerturbationKind::surface_tilt_y, 2, 2}, angle_deg));
        const double deviation = prism_deviation(angle_deg * kDegree);
        CHECK(std::hypot(about_x.direction.x, about_x.direction.y) == about(std::sin(deviation), 1e-11));
        CHECK(about_x.direction.x == 0);
        CHECK(about_y.direction.y == 0);
        CHECK(std::fabs(about_y.direction.x) == about(std::sin(deviation), 1e-11));
        // (n - 1) times the wedge, and (n + 1) n / 6 of its square more.
        const double third = (kPrismIndex + 1) * kPrismIndex / 6 * std::pow(angle_deg * kDegree, 2);
        CHECK(deviation / (kPrismIndex - 1) == about(angle_deg * kDegree * (1 + third), 2 * third * third + 1e-12));
    }
}

TEST_CASE("a plate that is tilted moves light aside, and one off the axis does nothing") {
    const double tilt_deg = 12, sine = std::sin(tilt_deg * kDegree);
    const TracedRay tilted = axial_ray(with_perturbation(plate(), {PerturbationKind::element_tilt_x, 1, 2}, tilt_deg));
    const double aside =
        4 * sine * (1 - std::cos(tilt_deg * kDegree) / std::sqrt(kPrismIndex * kPrismIndex - sine * sine));
    CHECK(std::fabs(tilted.at(50).y) == about(aside, 1e-12));
    CHECK(std::hypot(tilted.direction.x, tilted.direction.y) < 1e-15);
    const TracedRay moved = axial_ray(with_perturbation(plate(), {PerturbationKind::element_decentre_y, 1, 2}, 3));
    CHECK(moved.at(50) == axial_ray(plate()).at(50));
}

TEST_CASE("an element is turned about its middle") {
    // The middle of the plate is 4 mm behind the stop; both faces keep their distance from it, and the film its place.
    const LensSystem copy = with_perturbation(plate(), {PerturbationKind::element_tilt_x, 1, 2}, 12);
    const Affine<double> front = copy.surfaces[1].placement.frame(), rear = copy.surfaces[2].placement.frame();
    const Vec3d front_at = front.origin + Vec3d{0, 0, 2}, rear_at = rear.origin + Vec3d{0, 0, 6};
    CHECK(length(front_at - Vec3d{0, 0, 4}) == about(2, 1e-14));
    CHECK(length(0.5 * (front_at + rear_at) - Vec3d{0, 0, 4}) < 1e-14);
    CHECK(copy.film_position() == plate().film_position());
}

TEST_CASE("a surface has its own errors within those of its element") {
    // The front face turned by 2 degrees in an element that is turned back by as much meets light at a right angle.
    const std::vector<Perturbation> errors = {{PerturbationKind::element_tilt_x, 1, 2},
                                              {PerturbationKind::surface_tilt_x, 1, 1}};
    const double sizes[] = {-2, 2};
    const TracedRay ray = axial_ray(perturbed(plate(), errors, sizes));
    CHECK(std::fabs(ray.direction.y) == about(std::sin(prism_deviation(2 * kDegree)), 1e-12));
}

TEST_CASE("decentres along x and y are one vector, and tilts are counted together") {
    const std::vector<Perturbation> errors = {{PerturbationKind::surface_decentre_x, 1, 1},
                                              {PerturbationKind::surface_decentre_y, 1, 1},
                                              {PerturbationKind::surface_decentre_x, 1, 1},
                                              {PerturbationKind::surface_tilt_y, 2, 2}};
    const double sizes[] = {0.1, -0.2, 0.05, 3};
    const LensSystem copy = perturbed(plate(), errors, sizes);
    CHECK(copy.surfaces[1].placement.decentre.x == about(0.15, 1e-14));
    CHECK(copy.surfaces[1].placement.decentre.y == about(-0.2, 1e-14));
    CHECK(copy.surfaces[2].placement.tilt_deg.y == about(3, 1e-14));
    CHECK(copy.surfaces[1].placement.returns);
    CHECK(copy.surfaces[2].placement.returns);
}

TEST_CASE("a melt has the index and the Abbe number asked for, whatever its formula") {
    // N-BK7 as SCHOTT's data sheet has it.
    const Glass sellmeier =
        Glass::sellmeier({{1.03961212, 0.00600069867}, {0.231792344, 0.0200179144}, {1.01046945, 103.560653}});
    std::vector<Glass::TablePoint> points;
    for (const double nm : {404.66, kLineF_nm, kLineD_nm, kLineC_nm, 1014.0})
        points.push_back({nm, sellmeier.index(nm)});
    const auto abbe = [](const Glass& g) {
        return (g.index(kLineD_nm) - 1) / (g.index(kLineF_nm) - g.index(kLineC_nm));
    };
    for (const Glass& glass : {sellmeier, Glass::from_abbe_number(1.6, 40), Glass::table(points)}) {
        const Glass melt = with_melt_error(glass, -7e-4, 0.008);
        CHECK(melt.index(kLineD_nm) - glass.index(kLineD_nm) == about(-7e-4, 1e-11));
        CHECK(abbe(melt) / abbe(glass) == about(1.008, 1e-11));
        CHECK(with_melt_error(glass, 0, 0) == glass);
    }
}

TEST_CASE("errors that no lens can have are refused with one line") {
    const auto refusal = [](Perturbation error, double size) {
        return message_of([&] { with_perturbation(plate(), error, size); });
    };
    CHECK(contains(refusal({PerturbationKind::radius, 3, 3}, 1),
                   "there is no surface 3; the lens has 3, counted from 0"));
    CHECK(contains(refusal({PerturbationKind::element_tilt_x, 1, 9}, 1), "there is no surface 9"));
    CHECK(contains(refusal({PerturbationKind::index, 1, 1}, -0.6), "reduces its index below 1"));
    CHECK(contains(refusal({PerturbationKind::abbe_percent, 1, 1}, 1), "the dispersion of glass"));
}
