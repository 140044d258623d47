// How much light hard lenses let through: on the axis against closed forms and bisected rays, off it against the closed
// form of a round hole.

#include <cmath>
#include <string>
#include <vector>

#include "about.hpp"
#include "field_picture.hpp"
#include "measurement.hpp"
#include "optics/hard_lens_list.hpp"
#include "optics/lens/exposure.hpp"

using namespace realcam;
using namespace realcam::test;

namespace {

/// A round hole of this radius in front of a film in air.
LensSystem hole(double radius, double distance) {
    return with_film(lens_of({stop_plane(0, radius)}), distance, distance);
}

/// Irradiance of an off-axis film point under a parallel round source of radiance 1 (P. D. Foote, Scientific Papers of
/// the Bureau of Standards 263, 1915).
double irradiance_under_hole(double radius, double distance, double off_axis) {
    const double z2 = distance * distance, r2 = off_axis * off_axis, a2 = radius * radius;
    const double sum = z2 + r2 + a2;
    // 1 - (z2 + r2 - a2) / sqrt(sum^2 - 4 a2 r2), without its cancellation.
    const double root = std::sqrt(sum * sum - 4 * a2 * r2), excess = z2 + r2 - a2;
    return 0.5 * M_PI * (root * root - excess * excess) / (root * (root + excess));
}

}  // namespace

TEST_CASE("a camera with a hard lens sees a uniform field by pi L sin^2(theta') on the axis, by every model") {
    for (const LensGroup& group : hard_lenses()) {
        double worst = 0, ideal = 0;
        for (const HardLens& hard : group.lenses) {
            CAPTURE(hard.name);
            double truth = bisected_irradiance(hard.lens);
            const auto between = [](double outer, double inner) { return M_PI * (outer * outer - inner * inner); };
            if (hard.name == "f/0.7") truth = between(FastLens::sine_behind(FastLens::kStop), 0);
            if (hard.name == "two conics")
                truth = between(Cassegrain::sine_behind(Cassegrain::kRim), Cassegrain::sine_behind(Cassegrain::kHole));
            CHECK(axis_irradiance(hard.lens) == about(truth, 1e-12));
            const double on_axis = 1e-4 * hard.lens.film_width;
            for (const CameraModel model : kModels) {
                const FieldPicture picture = photograph(hard.lens, on_axis, 4, 1024, model);
                CHECK(picture.finite);
                double& error = model == CameraModel::full_lens ? worst : ideal;
                error = std::max(error, std::fabs(picture.irradiance / truth - 1));
            }
            CHECK(photograph(hard.lens, hard.lens.film_width, 8, 64).finite);
        }
        const std::string tried = std::to_string(group.lenses.size()) + " lenses, 16384 rays";
        // About 1% of stratified samples miss: 0.05%.
        hold({"Lenses", group.what + ": irradiance on the axis", tried, "core", "float32", worst, 0.002, "of it"});
        // Rounding of weights and sums; cos^4 over a thousandth of the film.
        hold({"Lenses", group.what + ": irradiance on the axis, ideal models", tried, "core", "float32", ideal, 1e-5,
              "of it"});
    }
}

TEST_CASE("a hole from f/0.25 to f/500 lights the film beside the axis as its closed form says") {
    double worst = 0;
    for (const double radius : {100.0, 30.0, 5.0, 0.5, 0.05})
        for (const double distance : {50.0, 1.0}) {
            const double scale = distance / 50;
            const LensSystem lens = hole(radius * scale, distance);
            CHECK(axis_irradiance(lens) == about(irradiance_under_hole(radius, 50, 0), 1e-12));
            // Mean over a square film by Simpson's rule on 41 x 41 points: its error is below 1e-6 here.
            constexpr int kPoints = 40;
            double mean = 0;
            for (int i = 0; i <= kPoints; ++i)
                for (int k = 0; k <= kPoints; ++k) {
                    const auto factor = [](int j) { return j == 0 || j == kPoints ? 1.0 : j % 2 ? 4.0 : 2.0; };
                    const double off = 50 * std::hypot(i / double{kPoints} - 0.5, k / double{kPoints} - 0.5);
                    mean += factor(i) * factor(k) * irradiance_under_hole(radius, 50, off) / std::pow(3.0 * kPoints, 2);
                }
            const FieldPicture picture = photograph(lens, distance, 16, 256);
            worst = std::max(worst, std::fabs(picture.irradiance / mean - 1));
        }
    hold({"Lenses", "a hole from f/0.25 to f/500: mean irradiance of a film as wide as its distance",
          "10 holes, 65536 rays", "core", "float32", worst, 0.002, "of it"});
}

TEST_CASE("a lens whose entrance pupil lies at infinity takes pictures by the models that have a place for it") {
    // The stop is in the rear focal plane of a thin lens of 200 mm, and a second lens forms the image.
    const Glass glass = Glass::constant(1.5);
    const LensSystem lens =
        with_film(lens_of({refracting(100, 0, glass, 30), refracting(0, 200, Glass::air(), 30), stop_plane(20, 4),
                           refracting(50, 0, glass, 15), refracting(-50, 0, Glass::air(), 15)}),
                  45, 8);
    REQUIRE(std::isinf(first_order(lens, lens.wavelength_nm).entrance_pupil_position));
    const double truth = bisected_irradiance(lens);
    for (const CameraModel model : {CameraModel::full_lens, CameraModel::thick_lens}) {
        const FieldPicture picture = photograph(lens, 1e-3, 4, 1024, model);
        CHECK(picture.finite);
        CHECK(picture.irradiance == about(truth, 0.002));
    }
    for (const CameraModel model : {CameraModel::pinhole, CameraModel::thin_lens})
        CHECK(contains(camera_error(lens, model), "entrance pupil lies at infinity"));
    // A stop at the film is its own exit pupil.
    const LensSystem at_film = with_film(
        lens_of({refracting(50, 0, glass, 15), refracting(-50, 40, Glass::air(), 15), stop_plane(0, 4)}), 1e-30, 8);
    CHECK(photograph(at_film, 4, 4, 16).finite);
    CHECK(contains(camera_error(at_film, CameraModel::thick_lens), "exit pupil lies in the film"));
}
