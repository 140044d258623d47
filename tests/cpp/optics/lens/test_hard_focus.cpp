// Focus from the first vertex to infinity, against the lens equation and against rays in 50 digits.

#include <cmath>
#include <string>

#include "about.hpp"
#include "measurement.hpp"
#include "optics/centred_lenses.hpp"
#include "optics/hard_lens_list.hpp"
#include "optics/lens/best_focus.hpp"
#include "optics/oracle.hpp"
#include "refusal.hpp"

using namespace realcam;
using namespace realcam::test;

namespace {

/// Two faces without thickness between, f = 100 mm, so slow that spherical aberration (1.1 r^2 / f^2 of the distances)
/// is 1e-12.
LensSystem thin_lens() {
    return lens_of(
        {stop_plane(0, 1e-4), refracting(100, 0, Glass::constant(1.5), 5), refracting(-100, 0, Glass::air(), 5)});
}

double object_of(const LensSystem& focused_lens) {
    return focused_lens.focus_distance - focused_lens.film_position();
}

/// Relative error of the focus distance: of the object plane with the smallest spot on the film, found by tracing back
/// from the film.
double misfocus(const LensSystem& lens) {
    const double object = object_of(lens);
    LensSystem open = lens;
    open.stop_semi_diameter = lens.stop().clear_semi_diameter;
    const double image = best_focus_distance(open, lens.wavelength_nm, object);
    return std::fabs(image - lens.film_distance) / lens.focus_distance;
}

/// The plane of the least RMS spot of an axial point at infinity, for a lens whose stop is its first surface: the full
/// stop by Gauss and Legendre, rays in 50 digits.
double oracle_best_focus(const LensSystem& lens) {
    constexpr int kNodes = 12;
    Real cross = 0, square = 0;
    for (int k = 0; k < kNodes; ++k) {
        // Newton on the Legendre polynomial.
        double x = std::cos(M_PI * (k + 0.75) / (kNodes + 0.5)), slope = 0;
        for (int i = 0; i < 20; ++i) {
            double last = 1, value = x;
            for (int j = 2; j <= kNodes; ++j) {
                const double next = ((2 * j - 1) * x * value - (j - 1) * last) / j;
                last = value, value = next;
            }
            slope = kNodes * (x * value - last) / (x * x - 1);
            x -= value / slope;
        }
        const double weight = 2 / ((1 - x * x) * slope * slope);
        const double height = lens.stop_semi_diameter * std::sqrt(0.5 * (1 + x));
        const OracleRay ray = oracle_trace(lens, LightDirection::to_film, {height, 0, 0}, {0, 0, 1});
        REQUIRE(ray.status == RayStatus::ok);
        const Real m = ray.direction.x / ray.direction.z;
        const Real x0 = ray.origin.x - m * (ray.origin.z - lens.last_vertex());
        cross += weight * x0 * m;
        square += weight * m * m;
    }
    return static_cast<double>(-cross / square);
}

}  // namespace

TEST_CASE("a thin lens obeys the lens equation from twice its focal length to infinity") {
    const double f = 100;
    double worst = 0;
    int count = 0;
    for (const double focus :
         {400 * (1 + 1e-9), 400.001, 401.0, 450.0, 1e3, 1e4, 1e6, 1e8, 1e10, 1e13, 1e18, 1e30, 1e300}) {
        CAPTURE(focus);
        const LensSystem lens = focused(thin_lens(), focus);
        // s + s' = D and 1 / s + 1 / s' = 1 / f.
        const double image = 2 * f / (1 + std::sqrt(1 - 4 * f / focus));
        // At D = 4 f (1 + e) a rounding of D moves s' by its inverse square root: asked is what the object plane does.
        const double object = object_of(lens), steep = 1 / std::sqrt(1 - 4 * f / focus);
        CHECK(object >= lens.film_distance);
        worst = std::max(worst, std::fabs(lens.film_distance / image - 1) / steep);
        ++count;
    }
    CHECK(focused(thin_lens(), kInfinity).film_distance == about(f, 1e-11));
    hold({"Lenses", "focus of a thin lens, from life size to infinity",
          std::to_string(count) + " distances, 0.4 m to 1e297 m", "core", "float64", worst, 1e-9,
          "of the film distance"});
}

TEST_CASE("every bundled lens is sharp at the distance asked for, from its nearest to infinity") {
    double worst = 0;
    int count = 0;
    const auto try_at = [&](const LensSystem& lens, double distance) {
        LensSystem result;
        const std::string message = message_of([&] { result = focused(lens, distance); });
        REQUIRE(message == "(no error)");
        worst = std::max(worst, misfocus(result));
        ++count;
    };
    for (const std::string& name : centred_lens_names()) {
        CAPTURE(name);
        LensSystem lens = io::read_lens(name);
        if (lens.focusing.moves_group())
            for (const double distance : {1.0, 1.001, 10.0, 1e10}) try_at(lens, lens.focusing.nearest_mm * distance);
        lens.focusing = {};
        // The nearest distance that is not refused, to 1e5 mm / 2^45 = 3e-9 mm.
        double refused = 0.5 * lens.film_position(), near = 1e5;
        for (int i = 0; i < 45; ++i) {
            const double middle = 0.5 * (refused + near);
            (message_of([&] { focused(lens, middle); }) == "(no error)" ? near : refused) = middle;
        }
        for (const double share : {0.0, 1e-9, 1e-6, 1e-4, 1e-2, 1.0, 1e8}) try_at(lens, near * (1 + share));
        CHECK(contains(message_of([&] { focused(lens, refused * (1 - 1e-9)); }), "cannot focus at "));
    }
    // 1e-9 of the distance is what focused promises.
    hold({"Lenses", "object plane of focused lenses, from the nearest to 1e10 times as far",
          std::to_string(count) + " states", "core", "float64", worst, 1e-9, "of the focus distance"});
}

TEST_CASE("going round from the film to the object and back, as it is often done, ends nowhere near life size") {
    const LensSystem gauss = io::read_lens("double-gauss-50mm");
    double worst = 0;
    for (const double share : {1e-6, 1e-4, 1e-3}) {
        const double distance = 196.8623 * (1 + share);  // of the nearest
        LensSystem lens = gauss;
        double object = 0.5 * distance - 0.3 * lens.last_vertex();
        for (int i = 0; i < 50; ++i) {
            lens.film_distance = best_focus_distance(lens, lens.wavelength_nm, object);
            object -= object + lens.film_position() - distance;
        }
        lens.focus_distance = distance;
        const double error = misfocus(lens);
        worst = std::isnan(error) ? kInfinity : std::max(worst, error);
    }
    breaks({"Lenses", "fixed point of film and object, just above the nearest distance", "3 distances", "broken copy",
            "float64", worst, 1e-9, "of the focus distance"});
}

TEST_CASE("the object may stand on the first vertex") {
    int count = 0;
    double worst = 0;
    // Front focal points deep inside the lens.
    for (const LensSystem& whole : {io::read_lens("fisheye-6mm-220deg"), fisheye_270()}) {
        LensSystem lens = whole;
        lens.focusing = {};
        const double nearest = lens.last_vertex() + best_focus_distance(lens, lens.wavelength_nm, 0);
        for (const double object : {0.0, 1e-9, 1e-3, 1.0}) {
            const double distance = object + lens.last_vertex() + best_focus_distance(lens, lens.wavelength_nm, object);
            const LensSystem macro = focused(lens, distance);
            CHECK(std::fabs(object_of(macro) - object) <= 1e-9 * distance);
            worst = std::max(worst, misfocus(macro));
            ++count;
        }
        const std::string message = message_of([&] { focused(lens, nearest * (1 - 1e-6)); });
        CHECK(contains(message, "the nearest object plane that lens"));
        CHECK(contains(message_of([&] { focused(lens, 0.9 * nearest); }), "cannot focus at "));
    }
    hold({"Lenses", "focus on an object at the first vertex", std::to_string(count) + " distances", "core", "float64",
          worst, 1e-9, "of the focus distance"});
}

TEST_CASE("best focus is that of the full aperture in 50 digits") {
    // Stops in front: Gauss and Legendre know where the aperture ends.
    const LensSystem lenses[] = {singlet_with_stop(15, 0), contact_doublet(false), FastLens::lens(),
                                 scaled(singlet_with_stop(15, 0), 0.01), scaled(singlet_with_stop(15, 0), 20)};
    double worst = 0;
    for (const LensSystem& lens : lenses)
        worst = std::max(worst,
                         std::fabs(best_focus_distance(lens, lens.wavelength_nm, kInfinity) - oracle_best_focus(lens)) /
                             scale_of(lens));
    // Rounding of some hundred operations; the aberration itself is integrated exactly.
    hold({"Lenses", "best focus, 1 mm to 2 m, spherical aberration up to 3% of f", "5 lenses", "core", "float64", worst,
          1e-13, "of the focal length"});
    CHECK(best_focus_distance(Cassegrain::lens(), kLineD_nm, kInfinity) == about(Cassegrain::kBack, 1e-12));
    CHECK(best_focus_distance(FastLens::lens(), kLineD_nm, kInfinity) == about(FastLens::kBack, 1e-12));
}

TEST_CASE("errors tell two distances apart that are nearly equal") {
    const std::string message = message_of([&] { focused(thin_lens(), 400 * (1 - 1e-8)); });
    CHECK(contains(message, "0.399999996 m"));
    CHECK(contains(message, "is 0.4 m from it"));
}

TEST_CASE("light with more than eight edges is focused as a whole") {
    // A plate whose back has the sag a T9(2 u^2 - 1), u = r / R, bends the light alternately outwards and inwards, and
    // a rim passes some zones: cos(9 t) with u^2 = (1 + cos t) / 2. The light is five zones, with nine edges.
    constexpr double kIndex = 1.5, kUnit = 10, kAmplitude = -0.1, kRim = 10, kAway = 100, kStop = 9.5;
    constexpr double kT9[] = {0, 9, 0, -120, 0, 432, 0, -576, 0, 256};  // by powers of x
    std::vector<double> powers(10, 0.0);  // of u^2
    for (int n = 0; n < 10; ++n)
        for (int k = 0; k <= n; ++k) {
            double binomial = 1;
            for (int i = 0; i < k; ++i) binomial = binomial * (n - i) / (i + 1);
            powers[static_cast<std::size_t>(k)] += kT9[n] * binomial * std::pow(2, k) * ((n - k) % 2 == 0 ? 1 : -1);
        }
    Surface wavy = refracting(0, kAway, Glass::air(), 12);
    for (int k = 1; k < 10; ++k) {
        const double term = kAmplitude * powers[static_cast<std::size_t>(k)] / std::pow(kUnit, 2 * k);
        if (k == 1) wavy.curvature = 2 * term;
        if (k > 1) wavy.aspheric.push_back(term);
    }
    wavy.conic = -1;
    Surface rim = stop_plane(0, kRim);
    rim.type = SurfaceType::aperture;
    const LensSystem lens = lens_of({stop_plane(0, kStop), refracting(0, 5, Glass::constant(kIndex), 12), wavy, rim});
    // Snell's law on the slope of the sag, at a million heights of equal areas.
    constexpr int kRays = 1 << 20;
    double cross = 0, square = 0;
    int edges = 0;
    bool before = true;
    for (int i = 0; i < kRays; ++i) {
        const double r = kStop * std::sqrt((i + 0.5) / kRays), x = 2 * r * r / (kUnit * kUnit) - 1;
        double value = 0, slope = 0;
        for (int n = 9; n >= 0; --n) slope = slope * x + value, value = value * x + kT9[n];
        const double incline = std::atan(kAmplitude * slope * 4 * r / (kUnit * kUnit));
        const double refracted = std::asin(kIndex * std::sin(incline));  // NaN: total reflection
        const double m = std::tan(refracted - incline);
        // The vertex of the sag is the point of the axis, where T9(-1) = -1.
        const double height = r + m * (kAway - kAmplitude * (value + 1));
        const bool passes = std::fabs(height) <= kRim;
        edges += passes != before;
        before = passes;
        if (!passes) continue;
        cross += height * m;
        square += m * m;
    }
    CHECK(edges > 8);
    // The zones' edges lie between two of a million heights: some 1e-6 of the light, times their number.
    CHECK(best_focus_distance(lens, lens.wavelength_nm, kInfinity) == about(-cross / square, 1e-4));
}
