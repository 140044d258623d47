// Figures of copies. Truth: a surface that images infinity perfectly, out of focus by known lengths; diffraction's
// limit; and symmetries.

#include "optics/tolerance/tolerance_evaluator.hpp"

#include <cmath>
#include <numbers>
#include <thread>

#include "about.hpp"
#include "doctest/doctest.h"
#include "optics/tolerance/film_setting.hpp"
#include "optics/tolerance/perturbation.hpp"
#include "refusal.hpp"
#include "traced_ray.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

constexpr double kLensIndex = 1.5, kRadius = 20, kLensRim = 1.5;
constexpr double kFocus = kLensIndex * kRadius / (kLensIndex - 1);  ///< focus of the surface, behind its vertex

constexpr double kSlope = kLensRim / kFocus;  ///< approximate slope of the rays from the rim

/// A stop on an ellipsoid of glass with k = -1 / n^2, which images infinity perfectly on the axis, at f/20 in glass.
/// The film is in the glass, `defocus` behind the focus.
LensSystem perfect(double defocus = 0) {
    Surface ellipsoid = refracting(kRadius, 0, Glass::constant(kLensIndex), 2 * kLensRim);
    ellipsoid.conic = -1 / (kLensIndex * kLensIndex);
    LensSystem lens = lens_of({stop_plane(0, kLensRim), ellipsoid});
    lens.film_distance = kFocus + defocus;
    return lens;
}

StudyRequest one_colour(std::vector<Vec2<double>> fields, Compensators compensators = {}) {
    StudyRequest request;
    request.fields = std::move(fields);
    request.object_distance = kInfinity;
    request.colours = {{kLineD_nm, 1}};
    request.frequencies = {10, 40};
    request.compensators = compensators;
    return request;
}

bool same_bits(const CopyFigures& a, const CopyFigures& b) {
    bool same = a.settings == b.settings && a.focal_length == b.focal_length;
    for (std::size_t f = 0; f < a.fields.size(); ++f) {
        const FieldFigures &one = a.fields[f], &other = b.fields[f];
        same &= one.mtf == other.mtf && one.rms_spot == other.rms_spot && one.distortion == other.distortion;
        same &= one.at.x == other.at.x && one.at.y == other.at.y && one.light == other.light;
    }
    return same;
}

/// A double Gauss and four of its copies.
struct Copies {
    LensSystem lens = io::read_lens("double-gauss-50mm");
    std::vector<Perturbation> errors = {{PerturbationKind::radius_percent, 0, 0},
                                        {PerturbationKind::element_decentre_x, 0, 1},
                                        {PerturbationKind::surface_tilt_y, 4, 4},
                                        {PerturbationKind::irregularity_45, 2, 2}};
    std::vector<std::vector<double>> sizes = {{0, 0, 0, 0}, {0.1, 0.05, -0.02, 1}, {-0.2, 0, 0.03, 0}, {0, -0.1, 0, 2}};

    LensSystem operator[](std::size_t i) const { return perturbed(lens, errors, sizes[i]); }
};

}  // namespace

TEST_CASE("a perfect image has the contrast that diffraction leaves, and no spot") {
    const CopyFigures found = ToleranceEvaluator(perfect(), one_colour({{0, 0}}))(perfect());
    CHECK(found.fields[0].rms_spot < 1e-12);
    CHECK(found.fields[0].light == about(1, 1e-14));
    CHECK(found.fields[0].distortion == 0);
    CHECK(found.focal_length == about(kFocus / kLensIndex, 1e-12));  // 1 / power: the image lies in glass
    // At the rim n sin u = n r / sqrt(r^2 + l^2); the disc is even in that to its square.
    const double along = kFocus - perfect().surfaces[1].sag(kLensRim);
    const double aperture = kLensIndex * kLensRim / std::hypot(kLensRim, along);
    std::size_t i = 0;
    for (int direction = 0; direction < 2; ++direction)
        for (const double frequency : {10.0, 40.0}) {
            const double u = 1e-6 * kLineD_nm * frequency / (2 * aperture);
            const double limit = 2 / std::numbers::pi * (std::acos(u) - u * std::sqrt(1 - u * u));
            CHECK(found.fields[0].mtf[i++] == about(limit, aperture * aperture));
        }
}

TEST_CASE("out of focus, the spot and the contrast of rays are those of an even cone of light") {
    const double defocus = 0.4;
    const CopyFigures sharp = ToleranceEvaluator(perfect(), one_colour({{0, 0}}))(perfect());
    const CopyFigures blurred = ToleranceEvaluator(perfect(defocus), one_colour({{0, 0}}))(perfect(defocus));
    const double slope = kLensRim / (kFocus - perfect().surfaces[1].sag(kLensRim));
    CHECK(blurred.fields[0].rms_spot == about(defocus * slope / std::sqrt(2), slope * slope));
    for (std::size_t i = 0; i < 2; ++i) {
        const double x = 2 * std::numbers::pi * (i == 0 ? 10 : 40) * defocus * slope;
        const double contrast = std::fabs(2 * std::cyl_bessel_j(1, x) / x);
        CHECK(blurred.fields[0].mtf[i] / sharp.fields[0].mtf[i] == about(contrast, 10 * slope * slope));
    }
}

TEST_CASE("refocusing brings the film back to the focus") {
    for (const double defocus : {-0.3, 0.05}) {
        const LensSystem lens = perfect(defocus);
        const CopyFigures by_spot = ToleranceEvaluator(lens, one_colour({{0, 0}}, {.refocus = true}))(lens);
        CHECK(by_spot.settings.film_shift == about(-defocus, 1e-10));
        // Its square is a difference: of the spot that was, rounding leaves 1e-15 of the square.
        CHECK(by_spot.fields[0].rms_spot < 1e-7 * std::fabs(defocus) * kSlope);
        const Compensators by_contrast{.frequency = 40, .refocus = true};
        const CopyFigures sharp = ToleranceEvaluator(lens, one_colour({{0, 0}}, by_contrast))(lens);
        // At a distance z from the focus the contrast is less by (pi f s z)^2 / 2, s the slope at the rim.
        const double off = std::numbers::pi * 40 * kSlope * (sharp.settings.film_shift + defocus);
        CHECK(off * off / 2 < 1e-4);
        const CopyFigures best = ToleranceEvaluator(perfect(), one_colour({{0, 0}}))(perfect());
        CHECK(sharp.fields[0].mtf[1] == about(best.fields[0].mtf[1], 1e-4));
    }
}

TEST_CASE("a copy with another radius is refocused to its own focus") {
    const ToleranceEvaluator judge(perfect(), one_colour({{0, 0}}, {.refocus = true}));
    const double size = 0.5;
    const CopyFigures found = judge(perturbed(perfect(), {{PerturbationKind::radius, 1, 1}}, {&size, 1}));
    CHECK(found.settings.film_shift == about(kLensIndex * size / (kLensIndex - 1), 1e-9));
    CHECK(found.focal_length == about(kFocus / kLensIndex + size / (kLensIndex - 1), 1e-7));
    CHECK(found.fields[0].rms_spot < 1e-7 * kLensIndex * size / (kLensIndex - 1) * kSlope);
    // The film that was set is that of a lens that can be had.
    const LensSystem set = with_settings(perturbed(perfect(), {{PerturbationKind::radius, 1, 1}}, {&size, 1}),
                                         found.settings, {.refocus = true});
    CHECK(set.film_distance == about(kLensIndex * (kRadius + size) / (kLensIndex - 1), 1e-9));
}

TEST_CASE("a chief ray through the vertex is refracted there, which is all of the distortion") {
    const double angle = 0.2;
    const CopyFigures found = ToleranceEvaluator(perfect(), one_colour({{0, angle}, {angle, 0}}))(perfect());
    const double inside = std::asin(std::sin(angle) / kLensIndex);
    for (const FieldFigures& field : found.fields) {
        CHECK(std::hypot(field.at.x, field.at.y) == about(kFocus * std::tan(inside), 1e-9));
        // Near the axis the picture's scale is 1 / n of the angle, to 1e-6 of it at 1 mrad.
        CHECK(field.distortion == about(kLensIndex * std::tan(inside) / std::tan(angle) - 1, 1e-4));
    }
    CHECK(found.fields[0].at.y > 0);
    CHECK(found.fields[1].at.x > 0);
}

TEST_CASE("a film is set on three foci that do not lie on one line") {
    // Cones of light that meet in points of a plane.
    const double shift = 0.07, slope_x = 3e-3, slope_y = -5e-3, film = 50, half = 0.1;
    std::vector<FieldSpot> spots;
    std::vector<Vec2<double>> outwards;
    for (const Vec2<double> at : {Vec2<double>{10, 8}, {-12, 3}, {1, -9}, {0, 0}}) {
        const double focus = film + shift + slope_x * at.x + slope_y * at.y;
        FieldSpot spot{{}, 1, {at, {0, 0}, 1}, film, 1};
        for (int i = 0; i < 60; ++i) {
            const double r = half * std::sqrt((i + 0.5) / 60), a = 2.4 * i;
            const Vec2<double> slope{r * std::cos(a), r * std::sin(a)};
            spot.rays.push_back({{at.x - focus * slope.x, at.y - focus * slope.y}, slope, 1.0 / 60});
        }
        spots.push_back(spot);
        outwards.push_back({0, 1});
    }
    const FilmAdjustment small = film_for_small_spots(spots, {true, true});
    CHECK(small.shift == about(shift, 1e-10));
    CHECK(small.slope.x == about(slope_x, 1e-10));
    CHECK(small.slope.y == about(slope_y, 1e-10));
    CHECK(mean_square(spots, small) < 1e-20);
    const FilmAdjustment sharp = film_for_high_contrast(spots, outwards, 20, {true, true});
    CHECK(mean_contrast(spots, outwards, 20, sharp) == about(1, 1e-4));
    // Without any freedom it stays.
    CHECK(film_for_small_spots(spots, {false, false}).shift == 0);
}

TEST_CASE("an element off the axis is found and moved back") {
    const LensSystem lens = io::read_lens("double-gauss-50mm");
    const Compensators compensators{.refocus = true, .shift = ElementShift{0, 1, false, 0.5}};
    const ToleranceEvaluator judge(
        lens, one_colour({{0, 0}, {0.1, 0.1}, {-0.1, 0.1}, {0.1, -0.1}, {-0.1, -0.1}}, compensators));
    const std::vector<Perturbation> errors = {{PerturbationKind::element_decentre_x, 0, 1},
                                              {PerturbationKind::element_decentre_y, 0, 1}};
    const double sizes[] = {0.15, -0.08};
    const Vec3d shift = judge(perturbed(lens, errors, sizes)).settings.element_shift;
    // Steps of 0.5 / 64 at last, whose parabola finds the middle to a part of them.
    CHECK(std::fabs(shift.x + 0.15) < 0.01);
    CHECK(std::fabs(shift.y - 0.08) < 0.01);
    CHECK(shift.z == 0);
}

TEST_CASE("a lens that is turned about its axis by 90 degrees has the same figures") {
    const LensSystem lens = io::read_lens("double-gauss-50mm");
    const ToleranceEvaluator along_x(lens, one_colour({{0.15, 0}}, {.refocus = true}));
    const ToleranceEvaluator along_y(lens, one_colour({{0, 0.15}}, {.refocus = true}));
    const double size = 0.2, back = -0.2;
    const auto figures = [&](const ToleranceEvaluator& judge, PerturbationKind kind, double by) {
        return judge(perturbed(lens, {{kind, 2, 4}}, {&by, 1})).fields[0];
    };
    const FieldFigures x = figures(along_x, PerturbationKind::element_decentre_x, size);
    const FieldFigures y = figures(along_y, PerturbationKind::element_decentre_y, size);
    const FieldFigures other = figures(along_y, PerturbationKind::element_decentre_y, back);
    for (std::size_t i = 0; i < 4; ++i) CHECK(x.mtf[i] == about(y.mtf[i], 1e-9));
    CHECK(x.rms_spot == about(y.rms_spot, 1e-9));
    CHECK(x.at.x == about(y.at.y, 1e-11));
    // To the other side it is another corner that is soft.
    CHECK(std::fabs(other.rms_spot - y.rms_spot) > 1e-3 * y.rms_spot);
}

TEST_CASE("a copy without errors is the lens as drawn, and copies are the same on any thread") {
    const Copies copies;
    const ToleranceEvaluator judge(copies.lens, one_colour({{0, 0}, {0.15, 0.1}}, {.frequency = 20, .refocus = true}));
    CHECK(same_bits(judge(copies[0]), judge(copies.lens)));
    std::vector<CopyFigures> once, again(copies.sizes.size());
    for (std::size_t i = 0; i < again.size(); ++i) once.push_back(judge(copies[i]));
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < again.size(); ++i) threads.emplace_back([&, i] { again[i] = judge(copies[i]); });
    for (std::thread& thread : threads) thread.join();
    for (std::size_t i = 0; i < again.size(); ++i) CHECK(same_bits(once[i], again[i]));
    CHECK(!same_bits(once[0], once[1]));
}

TEST_CASE("a field from which no light comes is refused") {
    CHECK(contains(message_of([] { ToleranceEvaluator(perfect(), one_colour({{0, 1.6}})); }), "field angle"));
}
