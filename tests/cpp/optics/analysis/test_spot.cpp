// Spots against closed forms. tests/truth compares them with a run of OpticStudio.

#include "optics/analysis/spot.hpp"

#include <algorithm>
#include <cmath>

#include "about.hpp"
#include "doctest/doctest.h"
#include "traced_ray.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

Spot spot(const LensSystem& lens, const FieldPoint& field, std::vector<PupilPoint> pattern) {
    return spot_of(field_rays(lens, lens.wavelength_nm, field, std::move(pattern)), lens.film_distance);
}

}  // namespace

TEST_CASE("a perfect image has no spot, and a defocused one the closed form's") {
    const double f = 100, radius = 80;
    CHECK(spot(paraboloid(f, radius, 0), {}, hexapolar(10)).about_chief.max_radius < 1e-9);
    for (const double defocus : {-0.5, 3.0}) {
        // All rays meet in the focus; at T to the axis, tan(T / 2) = r / 2f, they meet the film D tan T from it.
        const Spot s = spot(paraboloid(f, radius, defocus), {}, gauss_rings(30));
        const auto tangent = [&](double r) { return std::tan(2 * std::atan(r / (2 * f))); };
        CHECK(spot(paraboloid(f, radius, defocus), {}, hexapolar(3)).about_chief.max_radius ==
              about(std::fabs(defocus) * tangent(radius), 1e-10));
        // With u = (r / 2f)^2 and t its value at the edge: mean of 4 u / (1 - u)^2 over 0..t.
        const double t = std::pow(radius / (2 * f), 2);
        const double mean = 4 * (std::log(1 - t) + t / (1 - t)) / t;
        CHECK(s.about_centroid.rms_radius == about(std::fabs(defocus) * std::sqrt(mean), 1e-10));
        CHECK(std::hypot(s.centroid.x, s.centroid.y) < 1e-10);
    }
}

TEST_CASE("the spot of coma lies beside its chief ray") {
    // A paraboloid at f/10, 1e-3 rad off the axis. With s = f field (r / f)^2 / 4, a ray at the share p of the stop's
    // radius and azimuth a lies s p^2 (2 + cos 2a, sin 2a) from the chief ray; the mean over the disc is s (1, 0).
    const double f = 100, radius = 5, field = 1e-3;
    const Spot s = spot(paraboloid(f, radius, 0), {field}, gauss_rings(8));
    const double coma = field * f * std::pow(radius / f, 2) / 4;
    // Third order: (r / f)^2 = 0.25% of it is left out.
    CHECK(std::fabs(s.centroid.y - s.chief.y) == about(coma, 5e-3));
    CHECK(std::fabs(s.centroid.x) < 1e-10);
    // About the chief ray the mean square is s^2 (4 + 1) / 3, about the centroid less its square.
    CHECK(s.about_chief.rms_radius == about(coma * std::sqrt(5.0 / 3), 5e-3));
    CHECK(s.about_centroid.rms_radius == about(coma * std::sqrt(2.0 / 3), 5e-3));
}

TEST_CASE("blocked rays are no points of a spot") {
    const LensSystem lens = io::read_lens("double-gauss-50mm");
    const Spot s = spot(lens, {0.3}, square_grid(30));
    int passing = 0;
    for (std::size_t i = 0; i < s.points.size(); ++i) {
        CHECK(std::isnan(s.points[i].x) == !s.rays.passes(i));
        passing += static_cast<int>(s.rays.passes(i));
    }
    CHECK(passing > 100);
    CHECK(passing < static_cast<int>(s.points.size()));
    CHECK(std::isfinite(s.about_centroid.rms_radius));
}
