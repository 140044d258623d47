// Point spread functions: closed forms of perfect and defocused pupils, and results that must not depend on the method.
// tests/python/design/test_psf.py compares real lenses with another program's propagation.

#include "optics/analysis/psf.hpp"

#include <cmath>

#include "about.hpp"
#include "doctest/doctest.h"
#include "measurement.hpp"
#include "optics/analysis/point_bundle.hpp"
#include "optics/analysis/psf_pupil.hpp"
#include "traced_ray.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

constexpr double kAiryRing = 3.8317059702075123 / M_PI;

/// By the f-number of the sine of its outermost ray.
LensSystem paraboloid_of(double f, double f_number, double defocus = 0) {
    return paraboloid(f, 2 * f * std::tan(0.5 * std::asin(0.5 / f_number)), defocus);
}

PsfRequest request_for(const LensSystem& lens, double field_deg = 0) {
    return {{field_deg * kDegree, kInfinity}, {{lens.wavelength_nm, 1}}, lens.film_distance};
}

double value(const Psf& psf, int x, int y) {
    return psf.values[static_cast<std::size_t>((psf.size / 2 + y) * psf.size + psf.size / 2 + x)];
}

double largest_difference(const Psf& a, const Psf& b) {
    double worst = 0, peak = 0;
    for (std::size_t i = 0; i < a.values.size(); ++i) {
        worst = std::max(worst, std::fabs(a.values[i] - b.values[i]));
        peak = std::max(peak, a.values[i]);
    }
    return worst / peak;
}

/// The PSF of a perfect paraboloid at a distance from its focus, per um^2. A ray at the height r = 2 f tan(T / 2) has
/// the direction cosine s = sin T: energy r dr on s ds, so that the amplitude is the root of r dr / s ds, and the field
/// the integral of it times J0(k s q).
double perfect(double f, double f_number, double wavelength_nm, double q_um) {
    constexpr int kNodes = 100;  // for 11 periods of J0 at most
    static const std::vector<GaussNode> nodes = [] {
        std::vector<GaussNode> all;
        for (int i = 0; i < kNodes; ++i) all.push_back(gauss_node(kNodes, i));
        return all;
    }();
    const double k = 2000 * M_PI / wavelength_nm, edge = 0.5 / f_number;  // 1/um
    const double height = 2 * f * std::tan(0.5 * std::asin(edge));
    double field = 0;
    for (const GaussNode& node : nodes) {
        const double s = edge * node.node, cosine = std::sqrt(1 - s * s);
        const double energy = 4 * f * f * std::tan(0.5 * std::asin(s)) / (1 + cosine) / cosine / s;  // r dr/ds / s
        field += node.weight * edge * std::sqrt(energy) * std::cyl_bessel_j(0.0, k * s * q_um) * s;
    }
    return std::pow(2 * M_PI * field * k / (2 * M_PI), 2) / (M_PI * height * height);
}

/// Position of the values' first zero along x or y, in grid points.
double first_zero(const Psf& psf, bool along_y) {
    const auto at = [&](int i) { return along_y ? value(psf, 0, i) : value(psf, i, 0); };
    int i = 1;
    while (at(i + 1) < at(i)) ++i;
    // The field, whose square the values are, crosses zero between the least value and the smaller of its neighbours.
    const int low = at(i - 1) < at(i + 1) ? i - 1 : i;
    const double before = std::sqrt(at(low)), after = std::sqrt(at(low + 1));
    return low + before / (before + after);
}

}  // namespace

TEST_CASE("the PSF of a perfect mirror is the closed form, from f/0.7 to f/64") {
    for (const double f_number : {0.7, 1.0, 4.0, 22.0, 64.0}) {
        const LensSystem lens = paraboloid_of(100, f_number);
        const Psf psf = psf_of(lens, request_for(lens));
        const double peak = perfect(100, f_number, lens.wavelength_nm, 0);
        double worst = 0;
        for (int y = -64; y < 64; y += 7)
            for (int x = -64; x < 64; x += 9) {
                const double q = psf.pitch_um * std::hypot(x, y);
                worst =
                    std::max(worst, std::fabs(value(psf, x, y) - perfect(100, f_number, lens.wavelength_nm, q)) / peak);
            }
        char what[80];
        std::snprintf(what, sizeof what, "PSF of a perfect paraboloid at f/%g, closed form", f_number);
        hold({"Truth", what, "285 points of 128 x 128", "core", "float64", worst, 1e-6, "of the peak"});
        CHECK(psf.strehl == about(1, 1e-7));
    }
}

TEST_CASE("Airy's ring, the light inside it, and the modulation of a perfect lens") {
    double worst_ring = 0, worst_light = 0, worst_mtf = 0;
    for (const double f_number : {4.0, 5.6, 8.0, 11.0, 16.0, 22.0}) {
        const LensSystem lens = paraboloid_of(100, f_number);
        const double detail = 1e-3 * lens.wavelength_nm * f_number;
        PsfRequest request = request_for(lens);
        request.pitch_um = detail / 16;
        worst_ring = std::max(worst_ring, std::fabs(first_zero(psf_of(lens, request), false) / 16 / kAiryRing - 1));
        request.pitch_um = detail / 4;
        request.size = 256;
        const Psf psf = psf_of(lens, request);
        worst_light = std::max(worst_light, std::fabs(energy_inside(psf, kAiryRing * detail) - 0.8378));
        for (double v = 0.05; v < 1.2; v += 0.05) {
            const double w = std::min(v, 1.0), closed = 2 / M_PI * (std::acos(w) - w * std::sqrt(1 - w * w));
            for (const bool tangential : {false, true})
                worst_mtf = std::max(worst_mtf, std::fabs(modulation(psf, 1e3 * v / detail, tangential) - closed));
        }
    }
    // At f/4 the paraboloid's amplitude rises towards the edge by (r / 2f)^2 = 0.4%, which makes the ring 0.1% smaller.
    hold({"Truth", "first dark ring of a perfect lens against 1.22 wavelength f-number", "f/4 to f/22", "core",
          "float64", worst_ring, 3e-3, "of itself"});
    hold({"Truth", "light inside the first dark ring of a perfect lens against 83.78%", "f/4 to f/22", "core",
          "float64", worst_light, 3e-3, "of the light"});
    // An array of 64 wavelength f-number loses the light beyond, 0.6%, and with it the cusp of the curve at 0.
    hold({"Truth", "MTF of a perfect lens, closed form", "f/4 to f/22, 24 frequencies, 2 directions", "core", "float64",
          worst_mtf, 5e-3, "of 1"});
}

// On the axis the field is the integral over the pupil, W020 its edge's optical path difference. Where the pupil holds
// few zones, the light is brightest before the focus (Y. Li and E. Wolf, J. Opt. Soc. Am. A 1, 801, 1984): the
// inverse square of the distance, and W020 by the difference of the curvatures. At f/64 there are 10 zones.
TEST_CASE("light on the axis out of focus has the closed form") {
    double worst = 0, worst_few = 0;
    for (const double f_number : {8.0, 64.0})
        for (const double waves : {-1.5, -1.0, -0.5, -0.25, 0.25, 0.5, 1.0, 1.5}) {
            const double f = 100, radius = 2 * f * std::tan(0.5 * std::asin(0.5 / f_number));
            const LensSystem sharp = paraboloid_of(f, f_number);
            const double wave = 1e-6 * sharp.wavelength_nm,
                         defocus = f / (1 - 2 * waves * wave * f / (radius * radius)) - f;
            const LensSystem lens = paraboloid_of(f, f_number, defocus);
            PsfRequest request = request_for(lens);
            request.size = 16;
            const double x = M_PI * waves, closed = std::pow(std::sin(x) / x * f / (f + defocus), 2);
            const double found = value(psf_of(lens, request), 0, 0) / value(psf_of(sharp, request_for(sharp)), 0, 0);
            double& error = f_number > 10 ? worst_few : worst;
            error = std::max(error, std::fabs(found - closed));
        }
    // The mirror is no plane: its edge is nearer to the focus by a share (r / 2f)^2 of the path difference, 1e-3 at
    // f/8.
    hold({"Truth", "light on the axis of a defocused paraboloid at f/8, closed form", "8 defoci to 1.5 waves", "core",
          "float64", worst, 5e-3, "of the peak"});
    hold({"Truth", "the same at f/64, where the pupil holds 10 zones", "8 defoci to 1.5 waves", "core", "float64",
          worst_few, 1e-4, "of the peak"});
}

// Seen at T a round hole is an ellipse, cos T as high as wide, and the film is cut at T: rings are 1 / cos^2 T as high.
TEST_CASE("a pinhole off the axis has elliptical rings") {
    double worst = 0;
    for (const double field : {0.0, 20.0, 45.0, 70.0}) {
        LensSystem lens = lens_of({stop_plane(0, 0.05), refracting(0, 0, Glass::air(), 10)});
        lens.film_distance = 2000;
        PsfRequest request = request_for(lens, field);
        const double cosine = std::cos(field * kDegree), detail = 1e-3 * lens.wavelength_nm * 2000 / cosine / 0.1;
        request.pitch_um = detail / 16;
        request.size = 512;
        const Psf psf = psf_of(lens, request);
        worst = std::max(worst, std::fabs(first_zero(psf, false) / 16 / kAiryRing - 1));
        worst = std::max(worst, std::fabs(first_zero(psf, true) * cosine * cosine / 16 / kAiryRing - 1));
    }
    hold({"Truth", "Airy ellipses of a pinhole, 1.22 wavelength f-number / (cos, cos^3)", "0 to 70 degrees", "core",
          "float64", worst, 1e-2, "of themselves"});
}

TEST_CASE("light is the same by halves and by more rays") {
    double worst_half = 0, worst_more = 0;
    for (const auto& [name, field] : {std::pair{"double-gauss-50mm", 15.0},
                                      {"tessar-50mm", 0.0},
                                      {"mirror-telephoto-500mm", 1.5},
                                      {"fisheye-6mm-220deg", 80.0}}) {
        CAPTURE(name);
        const LensSystem lens = io::read_lens(name);
        const PsfRequest request = request_for(lens, field);
        psf_detail::PreparedPsf whole = psf_detail::prepare(lens, request, {});
        psf_detail::ColourPart& part = whole.parts[0];
        const BundleSampling sampling = psf_detail::checked_sampling(part, whole.psf, 0);
        part.bundle.mirrored = false;
        part.light = plane_waves(part.bundle, {sampling.arms + sampling.arms % 2, sampling.nodes});
        psf_detail::add_waves(whole.parts, {whole.psf.size, 1e-3 * whole.psf.pitch_um, {0, 0}}, whole.psf.values, {});
        const Psf psf = psf_of(lens, request);
        worst_half = std::max(worst_half, largest_difference(whole.psf, psf));
        PsfRequest more = request;
        more.rays = 4 * psf.rays;
        worst_more = std::max(worst_more, largest_difference(psf_of(lens, more), psf));
    }
    CHECK(worst_half < 1e-8);
    // The sum over the arms has an error of second order at the corners where two rims cut the light.
    hold({"Truth", "PSF with the number of rays that is chosen against four times as many", "4 lenses", "core",
          "float64", worst_more, 1e-4, "of the peak"});
}

TEST_CASE("all light is on the film") {
    // The share beyond a square of half side a is about 4 sqrt 2 / (pi^3) / (a / detail) of a perfect lens (its rings
    // fall off as q^-3): 1.1% of 128 points at a quarter of the detail.
    const LensSystem lens = paraboloid_of(100, 8);
    const Psf psf = psf_of(lens, request_for(lens));
    double sum = 0;
    for (const double v : psf.values) sum += v * psf.pitch_um * psf.pitch_um;
    CHECK(sum == about(1 - 0.1824 / 16, 1e-3));
    PsfRequest rays = request_for(paraboloid_of(100, 8, 0.05));
    rays.method = PsfMethod::geometric;
    const Psf geometric = psf_of(paraboloid_of(100, 8, 0.05), rays);
    CHECK(energy_inside(geometric, 20) == about(1, 1e-12));
    // An even disc of 50 / 16 um, but for the squares on its edge.
    CHECK(energy_inside(geometric, 0.5 * 50 / 16) == about(0.25, 0.05));
}

TEST_CASE("colours add up") {
    const LensSystem lens = io::read_lens("achromat-75mm");
    PsfRequest request = request_for(lens, 2);
    request.size = 32;
    request.pitch_um = 1;
    const auto of = [&](std::vector<PsfColour> colours) {
        request.colours = std::move(colours);
        return psf_of(lens, request);
    };
    const Psf blue = of({{486.1, 1}}), both = of({{486.1, 3}, {656.3, 1}});
    const double shift = both.centre_mm.y - of({{656.3, 1}}).centre_mm.y;
    CHECK(both.centre_mm.y == blue.centre_mm.y);
    CHECK(std::fabs(shift) > 1e-6);  // lateral colour: red is not about its own chief ray
    CHECK(both.colours[0].weight == 0.75);
    const Psf only_blue = of({{486.1, 3}, {486.1, 1}});
    CHECK(largest_difference(only_blue, blue) < 1e-12);
    CHECK(only_blue.strehl == about(blue.strehl, 1e-12));
}

TEST_CASE("the bounds of a sliver of light contain its whole width") {
    // Two equal circles that hardly overlap as seen from the field: slivers some mm long, and 0.3 to 0.6 mm wide.
    constexpr double kRadius = 10, kAway = 50;
    Surface rim = stop_plane(kAway, kRadius);
    rim.type = SurfaceType::aperture;
    LensSystem lens = lens_of({rim, stop_plane(0, kRadius), refracting(200, 3, Glass::constant(1.5), 20),
                               refracting(0, 0, Glass::air(), 20)});
    lens.film_distance = 400;
    for (double overlap = 0.3; overlap < 0.6; overlap += 0.02) {
        CAPTURE(overlap);
        const double field = std::atan((2 * kRadius - overlap) / kAway);
        const PointBundle bundle(lens, lens.wavelength_nm, {field, kInfinity}, lens.film_distance);
        // No ray passes on the long sides of the bounds. The pointed ends are narrower than the probe's cells.
        constexpr int kSteps = 100;
        for (int i = 0; i <= kSteps; ++i) {
            const double x = bundle.middle.x + (2.0 * i / kSteps - 1) * bundle.reach.x;
            const PointBundle::Entry at[2] = {{x, bundle.middle.y - bundle.reach.y},
                                              {x, bundle.middle.y + bundle.reach.y}};
            bool passes[2];
            bundle.pass(at, passes);
            CHECK_FALSE(passes[0]);
            CHECK_FALSE(passes[1]);
        }
        bool passes[1];
        bundle.pass({bundle.middle}, passes);
        CHECK(passes[0]);
    }
}
