// The diaphragm: blades leave open what they should, measured with rays.

#include <cmath>

#include "about.hpp"
#include "doctest/doctest.h"
#include "traced_ray.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

// A stop alone, with a rim of 10 mm, closed to the open area of a circle.
LensSystem stop_with_blades(int blades, double rounding, double rotation, double circle_radius) {
    LensSystem lens = lens_of({stop_plane(0, 10)});
    lens.iris = {blades, rounding, rotation};
    lens.stop_semi_diameter = circle_radius;
    return lens;
}

// Open share of a square of 20 mm, on an even grid of rays, as an area in mm^2.
double open_area(const LensSystem& lens) {
    constexpr int kGrid = 1024, kBlock = 256;
    const LensPath<double> path(lens, LightDirection::to_film, lens.wavelength_nm);
    LensRays<double, kBlock> rays;
    long open = 0;
    for (int row = 0; row < kGrid; ++row)
        for (int first = 0; first < kGrid; first += kBlock) {
            for (int i = 0; i < kBlock; ++i) {
                rays.origin.set(i, {-10 + 20 * (first + i + 0.5) / kGrid, -10 + 20 * (row + 0.5) / kGrid, -1});
                rays.direction.set(i, {0, 0, 1});
                rays.status[i] = 0;
            }
            trace_lens(path.view(), rays);
            for (int i = 0; i < kBlock; ++i) open += rays.status[i] == 0;
        }
    return 400.0 * static_cast<double>(open) / (static_cast<double>(kGrid) * kGrid);
}

}  // namespace

TEST_CASE("blades leave open the area of the circle that the f-number means") {
    for (const int blades : {0, 3, 5, 6, 9, 24})
        for (const double rounding : {0.0, 0.5, 1.0})
            for (const double radius : {2.0, 6.0, 9.5}) {
                CAPTURE(blades);
                CAPTURE(rounding);
                CAPTURE(radius);
                const double wanted = M_PI * radius * radius;
                // The grid's cells are 4e-4 mm^2; of those on the edge, up to 40 mm long, half a cell too
                // many or too few each, at random: sqrt(2000) / 2 cells.
                CHECK(std::fabs(open_area(stop_with_blades(blades, rounding, 0.3, radius)) - wanted) <
                      0.01 * std::sqrt(wanted));
            }
}

TEST_CASE("straight blades make a regular polygon, turned by the rotation") {
    for (const int blades : {5, 6, 8})
        for (const double rotation : {0.0, 0.4}) {
            const RayTracer trace(stop_with_blades(blades, 0, rotation, 4), LightDirection::to_film);
            // Area n h^2 tan(pi/n) = pi r^2.
            const double h = 4 * std::sqrt(M_PI / (blades * std::tan(M_PI / blades)));
            const auto open = [&](double r, double angle) {
                return trace({r * std::cos(angle), r * std::sin(angle), -1}, {0, 0, 1}).passed();
            };
            for (int b = 0; b < blades; ++b) {
                const double edge = rotation + 2 * M_PI * b / blades, corner = edge + M_PI / blades;
                // The opening is found by a quadrature that is good to 1e-6.
                CHECK(open(h * (1 - 1e-5), edge));
                CHECK_FALSE(open(h * (1 + 1e-5), edge));
                CHECK(open(h / std::cos(M_PI / blades) * (1 - 1e-5), corner));
                CHECK_FALSE(open(h / std::cos(M_PI / blades) * (1 + 1e-5), corner));
                const double between = edge + 0.5 * M_PI / blades;
                CHECK(open(h / std::cos(0.5 * M_PI / blades) * (1 - 1e-5), between));
                CHECK_FALSE(open(h / std::cos(0.5 * M_PI / blades) * (1 + 1e-5), between));
            }
        }
}

TEST_CASE("round blades make a circle, and wide open the blades are out of the way") {
    const RayTracer round(stop_with_blades(7, 1, 0.2, 5), LightDirection::to_film);
    const RayTracer wide(stop_with_blades(7, 0, 0.2, 10), LightDirection::to_film);
    for (double angle = 0; angle < 6.28; angle += 0.1) {
        const auto ray = [&](const RayTracer& trace, double r) {
            return trace({r * std::cos(angle), r * std::sin(angle), -1}, {0, 0, 1}).passed();
        };
        CHECK(ray(round, 5 * (1 - 1e-5)));
        CHECK_FALSE(ray(round, 5 * (1 + 1e-5)));
        CHECK(ray(wide, 10 - 1e-9));
        CHECK_FALSE(ray(wide, 10 + 1e-9));
    }
}

TEST_CASE("half rounded blades lie between the polygon and the circle") {
    const double straight = 4 * std::sqrt(M_PI / (6 * std::tan(M_PI / 6)));
    const RayTracer trace(stop_with_blades(6, 0.5, 0, 4), LightDirection::to_film);
    const auto edge = [&](double angle) {
        double low = 0, high = 10;
        for (int i = 0; i < 50; ++i) {
            const double r = 0.5 * (low + high);
            (trace({r * std::cos(angle), r * std::sin(angle), -1}, {0, 0, 1}).passed() ? low : high) = r;
        }
        return low;
    };
    const double middle = edge(0), corner = edge(M_PI / 6);
    CHECK(middle > straight * 1.005);
    CHECK(middle < 4);
    CHECK(corner > 4);
    CHECK(corner < straight / std::cos(M_PI / 6) * 0.995);
    // The edge of a blade is an arc of radius apothem / rounding about a point on the blade's own axis.
    const double radius = middle / 0.5, centre = middle - radius, r = edge(0.2);
    CHECK(std::hypot(r * std::cos(0.2) - centre, r * std::sin(0.2)) == about(radius, 1e-9));
}
