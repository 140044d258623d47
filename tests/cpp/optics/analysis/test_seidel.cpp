// Third-order sums: against closed forms, and against real rays of small apertures and fields. tests/truth compares
// them with a listing of CODE V.

#include "optics/analysis/seidel.hpp"
#include "optics/centred_lenses.hpp"

#include <algorithm>
#include <cmath>

#include "about.hpp"
#include "doctest/doctest.h"
#include "measurement.hpp"
#include "optics/analysis/wavefront.hpp"
#include "traced_ray.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

SeidelRow sum_of(const SeidelTable& table) {
    SeidelRow sum{};
    for (const SeidelRow& row : table.surfaces) {
        for (std::size_t k = 0; k < 5; ++k) sum.sums[k] += row.sums[k];
        for (std::size_t k = 0; k < 2; ++k) sum.colour[k] += row.colour[k];
        sum.petzval_curvature += row.petzval_curvature;
    }
    return sum;
}

SeidelTable sums(const LensSystem& lens, const FieldPoint& field) {
    return seidel(lens, lens.wavelength_nm, field, kLineF_nm, kLineC_nm);
}

/// Two surfaces and the stop on them, without thickness.
LensSystem thin_lens(double n, double c1, double c2, double radius) {
    LensSystem lens = lens_of({stop_plane(0, radius), refracting(0, 0, Glass::from_abbe_number(n, 50), radius),
                               refracting(0, 0, Glass::air(), radius)});
    lens.surfaces[1].curvature = c1;
    lens.surfaces[2].curvature = c2;
    return lens;
}

}  // namespace

// M. J. Kidger, Fundamental Optical Design (2001), and W. T. Welford, for a thin lens with the stop on it: with power
// K, bending B = (c1 + c2) / (c1 - c2), conjugate C = (u1 + u2) / (u1 - u2) and marginal height h. The sign of S_II is
// that of the invariant: here H = n (u' y - u y'), the negative of n u eta. Real rays, below, show it too.
TEST_CASE("a thin lens of any bending has the third-order aberrations of the closed forms") {
    const double h = 5, field = 0.1, f = 100;
    double worst = 0;
    int tried = 0;
    for (const double n : {1.5, 1.8})
        for (double bending = -3; bending <= 3; bending += 0.25)
            for (const double object : {kInfinity, 150.0, 40.0}) {
                const double K = 1 / f, difference = K / (n - 1);
                const LensSystem lens =
                    thin_lens(n, 0.5 * difference * (bending + 1), 0.5 * difference * (bending - 1), h);
                const SeidelRow s = sum_of(sums(lens, {std::atan(field), object}));
                const double u1 = h / object, u2 = u1 - h * K;
                const double C = (u1 + u2) / (u1 - u2), B = bending, H = h * field;
                const double h4 = h * h * h * h, K2 = K * K;
                const double inner = B + 2 * (n * n - 1) / (n + 2) * C;
                const double s1 = h4 * K2 * K / 4 *
                                  (n * n / ((n - 1) * (n - 1)) + (n + 2) / (n * (n - 1) * (n - 1)) * inner * inner -
                                   n / (n + 2) * C * C);
                const double s2 = h * h * K2 * H / 2 * ((n + 1) / (n * (n - 1)) * B + (2 * n + 1) / n * C);
                const double s3 = H * H * K, s4 = H * H * K / n;
                const double scale = h4 * K2 * K;
                worst = std::max({worst, std::fabs(s.sums[0] - s1) / (scale + std::fabs(s1)),
                                  std::fabs(s.sums[1] - s2) / (scale + std::fabs(s2)), std::fabs(s.sums[2] - s3) / s3,
                                  std::fabs(s.sums[3] - s4) / s4, std::fabs(s.sums[4]) / (field * field * s3)});
                // C_I = h^2 K / V; the stop on the lens leaves no lateral colour.
                const double v = (n - 1) / (Glass::from_abbe_number(n, 50).index(kLineF_nm) -
                                            Glass::from_abbe_number(n, 50).index(kLineC_nm));
                worst = std::max({worst, std::fabs(s.colour[0] - h * h * K / v) / (h * h * K / v),
                                  std::fabs(s.colour[1]) / (h * h * K / v)});
                ++tried;
            }
    // Rounding of some thirty operations whose terms are up to a hundred times larger than the result.
    hold({"Truth", "Seidel sums of a thin lens against its bending and conjugate", std::to_string(tried) + " lenses",
          "core", "float64", worst, 1e-12, "of the sum"});
}

TEST_CASE("perfect surfaces have no third-order spherical aberration") {
    Surface mirror = refracting(-200, 0, Glass::air(), 20);
    mirror.type = SurfaceType::mirror;
    const double of_sphere = sum_of(sums(lens_of({stop_plane(0, 20), mirror}), {})).sums[0];
    // A concave mirror in parallel light: W040 = h^4 / (4 R^3), so S_I = 2 h^4 / R^3.
    CHECK(of_sphere == about(2 * std::pow(20, 4) / std::pow(200, 3), 1e-13));
    mirror.conic = -1;
    CHECK(std::fabs(sum_of(sums(lens_of({stop_plane(0, 20), mirror}), {})).sums[0]) < 1e-14 * of_sphere);
    for (const double n : {1.5, 1.9}) {
        Surface surface = refracting(50, 0, Glass::constant(n), 20);
        surface.conic = -1 / (n * n);
        CHECK(std::fabs(sum_of(sums(lens_of({stop_plane(0, 20), surface}), {})).sums[0]) < 1e-14);
    }
    // An aplanatic surface, reached through a surface whose centre is the object: no coma and astigmatism either.
    const double n = 1.6, r = 30, to_centre = r / n;
    LensSystem lens = lens_of({stop_plane(0, 5), refracting(-20, r + to_centre - 20, Glass::constant(n), 5),
                               refracting(-r, 0, Glass::air(), 10)});
    const SeidelTable table = sums(lens, {0.02, 20});
    for (const std::size_t k : {0u, 1u, 2u}) CHECK(std::fabs(table.surfaces[2].sums[k]) < 1e-15);
    CHECK(std::fabs(table.surfaces[1].sums[0]) < 1e-15);
}

TEST_CASE("a conic is to third order a sphere with k c^3 / 8 of r^4, wherever the stop is") {
    for (const double conic : {-2.0, -0.7, 1.5}) {
        LensSystem lens = lens_of(
            {stop_plane(12, 5), refracting(40, 6, Glass::constant(1.6), 15), refracting(-90, 0, Glass::air(), 15)});
        LensSystem figured = lens;
        lens.surfaces[1].conic = conic;
        figured.surfaces[1].aspheric = {0.125 * conic / (40.0 * 40 * 40)};
        const SeidelTable a = sums(lens, {0.2}), b = sums(figured, {0.2});
        for (std::size_t k = 0; k < 5; ++k) CHECK(a.surfaces[1].sums[k] == about(b.surfaces[1].sums[k], 1e-12));
    }
}

namespace {

/// The lens with its stop closed and its film in the paraxial image of the object.
LensSystem with_share(LensSystem lens, double share, double object) {
    lens.stop_semi_diameter = share * lens.stop().clear_semi_diameter;
    lens.iris = {};
    for (Surface& s : lens.surfaces) s.inner_semi_diameter = 0;
    lens.film_distance = paraxial_image_distance(lens, lens.wavelength_nm, object);
    return lens;
}

/// Optical path differences of real rays through four points on the edge of the stop, divided by share^4; and the
/// distortion of the chief ray, mm, divided by share^3.
std::array<double, 5> real_aberrations(const LensSystem& whole, double share, double tangent, double object) {
    const LensSystem lens = with_share(whole, share, object);
    const FieldPoint field{std::atan(share * tangent), object};
    const FieldRays rays =
        field_rays(lens, lens.wavelength_nm, field, {{0, 1, 1}, {0, -1, 1}, {1, 0, 1}, {0.6, 0.8, 1}});
    const Wavefront wavefront =
        wavefront_of(lens, lens.wavelength_nm, rays, lens.film_distance, SphereCentre::chief, Removed::nothing);
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    const int count = static_cast<int>(lens.surfaces.size());
    const ParaxialRay chief = trace_paraxial(
        lens, lens.wavelength_nm, {-data.entrance_pupil_position * share * tangent, share * tangent}, 0, count);
    std::array<double, 5> result{};
    for (std::size_t i = 0; i < 4; ++i) result[i] = wavefront.opd[i] / std::pow(share, 4);
    result[4] = (wavefront.centre.y - chief.height - chief.slope * lens.film_distance) / std::pow(share, 3);
    return result;
}

}  // namespace

TEST_CASE("real wavefronts and chief rays of every lens go over into the third-order ones") {
    for (const double object_share : {kInfinity, 4.0}) {
        double worst = 0;
        for (const std::string& name : centred_lens_names()) {
            CAPTURE(name);
            const LensSystem lens = io::read_lens(name);
            const double f = std::fabs(first_order(lens, lens.wavelength_nm).effective_focal_length);
            const double object = object_share * f, tangent = std::min(0.5 * lens.film_height / f, 0.5);
            // Half the share leaves a quarter of the fifth-order rest, a sixteenth of the seventh: extrapolated twice.
            // Rounding, some 1e-9 waves, is divided by share^4.
            std::array<std::array<double, 5>, 3> at{};
            double share = 0.4;
            for (auto& values : at) values = real_aberrations(lens, share *= 0.5, tangent, object);
            const SeidelTable table = sums(with_share(lens, 1, object), {std::atan(tangent), object});
            const SeidelRow sum = sum_of(table);
            const WaveCoefficients w = table.waves(sum);
            const double edge = w.w040 + w.w222 + w.w220, c = 0.8;
            const std::array<double, 5> third = {edge + w.w131, edge - w.w131, w.w040 + w.w220,
                                                 w.w040 + w.w220 + c * w.w131 + c * c * w.w222,
                                                 table.transverse(sum).distortion};
            // The sum may be much smaller than the contributions of the surfaces, which determine the fifth order.
            double size_waves = 0, size_mm = 0;
            for (const SeidelRow& row : table.surfaces) {
                const WaveCoefficients v = table.waves(row);
                size_waves += std::fabs(v.w040) + std::fabs(v.w131) + std::fabs(v.w222) + std::fabs(v.w220);
                size_mm += std::fabs(table.transverse(row).distortion);
            }
            for (std::size_t i = 0; i < 5; ++i) {
                std::array<double, 2> first{};
                for (std::size_t k = 0; k < 2; ++k) first[k] = (4 * at[k + 1][i] - at[k][i]) / 3;
                const double limit = (16 * first[1] - first[0]) / 15;
                CAPTURE(i);
                CAPTURE(third[i]);
                CHECK(std::fabs(limit - third[i]) < 1e-5 * (i < 4 ? size_waves : size_mm));
                worst = std::max(worst, std::fabs(limit - third[i]) / (i < 4 ? size_waves : size_mm));
            }
        }
        hold({"Truth", "wavefront and distortion of real rays against W040 to W311, in the limit of small apertures",
              std::string("every bundled lens x 5 figures, object ") + (object_share == 4 ? "near" : "at infinity"),
              "core", "float64", worst, 1e-5, "of the surfaces' sum"});
    }
}

TEST_CASE("what has no third-order sums says so") {
    const LensSystem lens = io::read_lens("double-gauss-50mm");
    CHECK_THROWS_AS(sums(lens, {0.5 * M_PI}), InputError);
    CHECK_THROWS_AS(sums(lens, {0.1, -5}), InputError);
    CHECK_THROWS_AS(sums(lens, {std::nan("")}), InputError);
    // A plane-parallel plate.
    CHECK_THROWS_AS(
        sums(lens_of({stop_plane(1, 5), refracting(0, 5, Glass::constant(1.5), 9), refracting(0, 0, Glass::air(), 9)}),
             {0.1}),
        InputError);
}
