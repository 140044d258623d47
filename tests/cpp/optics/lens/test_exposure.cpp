// How much light reaches the film, against integrals that know nothing of the sampled region.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "about.hpp"
#include "doctest/doctest.h"
#include "field_picture.hpp"
#include "math/random.hpp"
#include "optics/centred_lenses.hpp"
#include "optics/lens/exposure.hpp"
#include "pupil_region.hpp"
#include "traced_ray.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

// Irradiance of a field of radiance 1, as a picture estimates it: pupil samples, their weights, and the rays
// that pass.
class SampledIrradiance {
public:
    explicit SampledIrradiance(const LensSystem& lens) : pupil_(lens, half_diagonal(lens)), trace_(lens) {}

    double operator()(double film_x, double film_y, int samples = 1 << 14) const {
        const auto sample = [&](int i) {
            const Vec2f u = sample_2d(hash32(99), static_cast<std::uint32_t>(i), 1);
            return sample_pupil(pupil_.view(), static_cast<float>(film_x), static_cast<float>(film_y), u.x, u.y);
        };
        double sum = 0;
        trace_(
            static_cast<float>(film_x), static_cast<float>(film_y), samples, [&](int i) { return sample(i).direction; },
            [&](int i, bool passes) { sum += passes ? static_cast<double>(sample(i).weight) : 0.0; });
        return sum / samples;
    }

private:
    Pupil pupil_;
    FilmPointTracer trace_;
};

// From f/13.5 on, the mirror lens's hole is larger than its stop, so that the real lens would be dark too.
bool is_dark(const std::string& name, double f_number) {
    return name == "mirror-telephoto-500mm" && f_number > 13.5;
}

// The source paper's equations 6 and 7 over the last surface: integral of cos(theta') cos(theta'') / d^2 dA
// over the points that see the scene, on a uniform grid in x and y. A coarse grid finds the part with light, first of
// the whole surface, then of the part found; a fine grid sums over it. Without blades both halves of the surface give a
// film point on the axis the same light.
double irradiance_over_last_surface(const LensSystem& lens, double film_x, double film_y) {
    constexpr int kBlock = 128, kCoarse = 96, kFine = 160;
    const Surface& last = lens.surfaces.back();
    const LensPath<double> path(lens, LightDirection::to_scene, lens.wavelength_nm);
    const Vec3d film{film_x, film_y, lens.film_distance};  // from the last vertex
    const double rim = last.clear_semi_diameter;
    const bool is_half = film_x == 0 && film_y == 0 && lens.iris.blades == 0;
    double x_min = -rim, x_max = rim, y_min = is_half ? 0 : -rim, y_max = rim, integral = 0;
    bool is_found = false;
    for (int level = 0; level < 6; ++level) {
        const int grid = is_found ? kFine : kCoarse;
        const int rows = is_half ? grid / 2 : grid;
        const double dx = (x_max - x_min) / grid, dy = (y_max - y_min) / rows;
        double left = rim, right = -rim, low = rim, high = -rim;
        integral = 0;
        LensRays<double, kBlock> rays;
        for (int first = 0; first < grid * rows; first += kBlock) {
            double factor[kBlock];
            Vec3d points[kBlock];
            for (int i = 0; i < kBlock; ++i) {
                const int k = first + i;
                const double x = x_min + (k % grid + 0.5) * dx, y = y_min + (k / grid + 0.5) * dy, r = std::hypot(x, y);
                factor[i] = 0;
                rays.status[i] = static_cast<int>(RayStatus::bad_input);
                rays.origin.set(i, film);
                rays.direction.set(i, {0, 0, -1});
                if (r > rim) continue;
                const double h = 1e-5 * rim, slope = (last.sag(r + h) - last.sag(std::fabs(r - h))) / (2 * h);
                points[i] = {x, y, last.sag(r)};
                const double radial = r > h ? slope / r : 0;
                const Vec3d normal = normalized(Vec3d{-radial * x, -radial * y, 1});
                const Vec3d to_surface = points[i] - film, d = normalized(to_surface);
                const double at_surface = -dot(d, normal);  // cos(theta'')
                if (at_surface <= 0) continue;  // seen from behind
                const double area = dx * dy / normal.z;
                factor[i] = -d.z * at_surface / dot(to_surface, to_surface) * area;
                rays.direction.set(i, d);
                rays.status[i] = 0;
            }
            trace_lens(path.view(), rays);
            for (int i = 0; i < kBlock; ++i) {
                if (rays.status[i] != 0) continue;
                integral += factor[i];
                left = std::min(left, points[i].x);
                right = std::max(right, points[i].x);
                low = std::min(low, points[i].y);
                high = std::max(high, points[i].y);
            }
        }
        if (left > right) {
            // A surface close to the film has its light on a speck of it, smaller than a cell: look where the
            // lines to the exit pupil cross it, with room on all sides.
            if (level > 0) return 0;
            const FirstOrder data = first_order(lens, lens.wavelength_nm);
            const double share = film.z / (lens.film_position() - data.exit_pupil_position);
            const double room = 1.5 * share * data.exit_pupil_diameter, x = film_x * (1 - share),
                         y = film_y * (1 - share);
            x_min = x - room, x_max = x + room, y_min = is_half ? 0 : y - room, y_max = y + room;
            continue;
        }
        if (is_found) break;
        if (is_half) low = 0;
        is_found = right - left > 0.5 * (x_max - x_min) && high - low > 0.5 * (y_max - y_min);
        x_min = std::max(left - 2 * dx, -rim);
        x_max = std::min(right + 2 * dx, rim);
        y_min = is_half ? 0 : std::max(low - 2 * dy, -rim);
        y_max = std::min(high + 2 * dy, rim);
    }
    return is_half ? 2 * integral : integral;
}

void check_relative_illumination(const LensSystem& lens, const SampledIrradiance& sampled, double on_axis,
                                 double truth_on_axis) {
    for (const double share : {0.33, 0.66, 0.95}) {
        CAPTURE(share);
        const double r = share * half_diagonal(lens), x = r * std::cos(0.7), y = r * std::sin(0.7);
        const double truth = irradiance_over_last_surface(lens, x, y) / truth_on_axis;
        const double found = sampled(x, y, 1 << 12) / on_axis;
        CAPTURE(truth);
        CAPTURE(found);
        // The requirement is 1%, or 0.1% of the light on the axis where there is hardly any light.
        CHECK(std::fabs(found - truth) <= std::max(0.01 * truth, 0.001));
    }
}

}  // namespace

TEST_CASE("light on the axis is pi sin^2(theta'), a quarter two stops down, and beside it a brute-force integral") {
    for (const std::string& name : centred_lens_names()) {
        double before = 0;
        for (const double f_number : {0.0, 11.0, 22.0}) {
            CAPTURE(name);
            CAPTURE(f_number);
            LensSystem lens = io::read_lens(name);
            if (f_number > 0) lens = stopped_down(lens, f_number);
            const double truth = bisected_irradiance(lens);
            const SampledIrradiance sampled(lens);
            const double on_axis = sampled(0, 0);
            if (is_dark(name, f_number)) {
                CHECK(truth == 0);
                CHECK(on_axis == 0);
                CHECK(sampled(5, 5) == 0);
                continue;
            }
            REQUIRE(truth > 0);
            // About 3% of the 16384 stratified samples miss: an error of 0.07%. The requirement is 0.5%.
            CHECK(on_axis == about(truth, 0.002));
            // The brute-force integral, on which the other checks rely: the light covers at least 140 x 140 grid
            // points.
            if (f_number != 11) {
                const double by_integral = irradiance_over_last_surface(lens, 0, 0);
                CHECK(by_integral == about(truth, 0.003));
                if (f_number == 0) check_relative_illumination(lens, sampled, on_axis, by_integral);
            }
            // sin^2 against the paraxial 1 / (4 N^2): 0.2% at f/11, and what pupil aberration a lens has there.
            if (f_number == 22) CHECK(before / on_axis == about(4, 0.02));
            before = on_axis;
        }
    }
}

TEST_CASE("relative illumination is that of a brute-force integral over the last surface, focused near at f/11" *
          doctest::test_suite("slow")) {
    for (const std::string& name : centred_lens_names()) {
        CAPTURE(name);
        LensSystem lens = io::read_lens(name);
        lens = stopped_down(focused(lens, near_focus(lens)), 11);
        const SampledIrradiance sampled(lens);
        check_relative_illumination(lens, sampled, sampled(0, 0), irradiance_over_last_surface(lens, 0, 0));
    }
}

TEST_CASE("blades change neither the light on the axis nor its integral") {
    const LensSystem open = io::read_lens("double-gauss-50mm");
    LensSystem bladed = stopped_down(open, 4);
    const double round = bisected_irradiance(bladed);
    bladed.iris = {6, 0.2, 0.1};
    const SampledIrradiance sampled(bladed);
    CHECK(sampled(0, 0) == about(round, 0.005));
    // A film point off the axis at an angle to the blades.
    CHECK(sampled(9, 5) == about(irradiance_over_last_surface(bladed, 9, 5), 0.005));
}

TEST_CASE("a film before a single mirror has pi sin^2(theta') on the axis") {
    // A ray at the height r of a paraboloid converges at theta' with tan(theta' / 2) = r / (2 f).
    for (const double radius : {1.0, 40.0, 90.0}) {
        const double sine = std::sin(2 * std::atan(radius / 200));
        CHECK(axis_irradiance(paraboloid(100, radius)) == about(M_PI * sine * sine, 1e-12));
    }
}
