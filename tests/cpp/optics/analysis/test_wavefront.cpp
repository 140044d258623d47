// Optical path differences: against perfect surfaces and closed forms, and against the same rays in fifty digits.
// tests/truth compares them with a listing of CODE V.

#include "optics/analysis/wavefront.hpp"

#include <algorithm>
#include <cmath>

#include "about.hpp"
#include "doctest/doctest.h"
#include "measurement.hpp"
#include "optics/oracle.hpp"
#include "traced_ray.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

Wavefront wavefront(const LensSystem& lens, const FieldPoint& field, std::vector<PupilPoint> pattern,
                    Removed removed = Removed::nothing, SphereCentre centre = SphereCentre::chief) {
    return wavefront_of(lens, lens.wavelength_nm, field_rays(lens, lens.wavelength_nm, field, std::move(pattern)),
                        lens.film_distance, centre, removed);
}

double largest(const Wavefront& w) {
    double worst = 0;
    for (std::size_t i = 0; i < w.opd.size(); ++i) {
        if (!w.rays.passes(i)) return kInfinity;
        worst = std::max(worst, std::fabs(w.opd[i]));
    }
    return worst;
}

}  // namespace

TEST_CASE("what images a point perfectly has no optical path difference") {
    const auto check = [](const char* what, const LensSystem& lens, const FieldPoint& field) {
        const Wavefront w = wavefront(lens, field, hexapolar(20));
        hold({"Truth", std::string("optical path difference of ") + what, std::to_string(w.opd.size()) + " rays",
              "core", "float64", largest(w), 1e-6, "waves"});
        CHECK(w.strehl == about(1, 1e-9));
        CHECK(w.rms < 1e-6);
    };
    // To 150 mm of a focal length of 100: rays that leave at more than 70 degrees.
    check("a paraboloid mirror, object at infinity", paraboloid(100, 150), {});
    for (const double n : {1.5, 1.9}) {
        Surface surface = refracting(50, 0, Glass::constant(n), 0);
        surface.conic = -1 / (n * n);
        surface.clear_semi_diameter = 0.99 * 50 / std::sqrt(1 - 1 / (n * n));  // nearly to the ellipsoid's equator
        LensSystem lens = lens_of({stop_plane(0, 0.999 * surface.clear_semi_diameter), surface});
        lens.film_distance = n * 50 / (n - 1);
        check("a refracting ellipsoid of conic -1/n^2, object at infinity", lens, {});
    }
    {
        const double R = 100, e = 0.6, near = R / (1 + e), far = R / (1 - e);
        Surface mirror = refracting(-R, 0, Glass::air(), 75);
        mirror.type = SurfaceType::mirror;
        mirror.conic = -e * e;
        LensSystem lens = lens_of({stop_plane(0, 75), mirror});
        lens.film_distance = -far;
        check("an ellipsoid mirror, object in one focus", lens, {0, near});
    }
    {
        // A concave surface about the object, then an aplanatic one: the image is virtual, n R in front of the centre.
        const double n = 1.6, r = 30;
        LensSystem lens = lens_of({stop_plane(0, 12), refracting(-20, r + r / n - 20, Glass::constant(n), 16),
                                   refracting(-r, 0, Glass::air(), 29)});
        lens.film_distance = -r - n * r;
        check("an aplanatic meniscus, near object and virtual image", lens, {0, 20});
    }
}

// From the focus F on, every ray has the same path. The sphere about the film's point, D behind F, has the radius f + D
// to the stop's image in the vertex; with T the angle to the axis, the law of cosines gives the path from F to it.
TEST_CASE("a defocused paraboloid has the closed form's optical path difference") {
    double worst = 0, worst_rms = 0, worst_strehl = 0;
    for (const double radius : {5.0, 80.0})
        for (const double defocus : {-0.3, 0.02, 2.0}) {
            const double f = 100;
            const LensSystem lens = paraboloid(f, radius, defocus);
            const Wavefront w = wavefront(lens, {}, gauss_rings(40));
            for (std::size_t i = 0; i < w.opd.size(); ++i) {
                const PupilPoint& p = w.rays.pattern[i];
                const long double D = defocus, half = std::atan(radius * std::hypot(p.x, p.y) / (2 * f));
                // 1 - cos T and sin T by the half angle: tan(T / 2) = r / 2f.
                const long double fall = 2 * std::sin(half) * std::sin(half), sine = std::sin(2 * half);
                const long double R = f + D, inside = D * D * sine * sine / R;
                // D (1 - cos T) - (R - sqrt(R^2 - D^2 sin^2 T)).
                const long double closed = D * fall - inside / (1 + std::sqrt(1 - inside / R));
                worst = std::max(worst, std::fabs(w.opd[i] - static_cast<double>(closed * 1e6L / lens.wavelength_nm)));
            }
            if (radius > 10) continue;
            // Nearly W020 r^2, with W020 that of the edge: RMS W020 / sqrt 12, Strehl (sin(pi W020) / pi W020)^2.
            const long double D = defocus, half = std::atan(radius / (2 * f)), sine = std::sin(2 * half);
            const double w020 =
                static_cast<double>((2 * D * std::sin(half) * std::sin(half) - D * D * sine * sine / (2 * (f + D))) *
                                    1e6L / lens.wavelength_nm);
            const double x = M_PI * w020;
            worst_rms = std::max(worst_rms, std::fabs(w.rms / (std::fabs(w020) / std::sqrt(12)) - 1));
            worst_strehl = std::max(worst_strehl, std::fabs(w.strehl - std::pow(std::sin(x) / x, 2)));
            CHECK(w.strehl_marechal == about(std::exp(-std::pow(2 * M_PI * w.rms, 2)), 1e-12));
            CHECK(w.peak_to_valley == about(std::fabs(w020), 0.01));  // no ray on the very edge and middle
        }
    hold({"Truth", "optical path difference of a defocused paraboloid, closed form", "6 mirrors x 6400 rays", "core",
          "float64", worst, 1e-6, "waves"});
    // A share e = (r / 2f)^2 = 6e-4 of W020 is of fourth order. With the edge's value for W020 it is symmetric about
    // r^2 = 1/2, and so in both figures by its square only: e^2 = 4e-7 in the RMS, (2 pi e W020 / 6)^2 = 1e-5 in the
    // Strehl ratio.
    hold({"Truth", "RMS wavefront of a defocused paraboloid against W020 / sqrt 12", "3 mirrors f/10", "core",
          "float64", worst_rms, 1e-6, "of itself"});
    hold({"Truth", "Strehl ratio of a defocused paraboloid against (sin(pi W020) / (pi W020))^2", "3 mirrors f/10",
          "core", "float64", worst_strehl, 1e-5, "of 1"});
}

TEST_CASE("tilt and focus are what a fit takes away") {
    const LensSystem lens = paraboloid(100, 5, 0.02);
    const Wavefront whole = wavefront(lens, {}, gauss_rings(12));
    const Wavefront level = wavefront(lens, {}, gauss_rings(12), Removed::tilt);
    const Wavefront focused = wavefront(lens, {}, gauss_rings(12), Removed::focus);
    CHECK(level.rms == about(whole.rms, 1e-9));  // there is no tilt on the axis
    // The fourth-order part, (r / 2f)^2 = 6e-4 of W020; over a disc it is sqrt(12 / 180) of that, in RMS over RMS.
    CHECK(focused.rms < 6.3e-4 * std::sqrt(12.0 / 180) * whole.rms);
    CHECK(focused.rms > 0);

    // Off the axis the paraboloid has coma, W131 r^3 cos; with the tilt of least squares its RMS is W131 / sqrt(72),
    // without W131 / sqrt 8 (V. N. Mahajan, Optical Imaging and Aberrations, part I, table 8-1).
    const Wavefront tilted = wavefront(paraboloid(100, 5), {1e-3}, gauss_rings(12));
    const Wavefront levelled = wavefront(paraboloid(100, 5), {1e-3}, gauss_rings(12), Removed::tilt);
    CHECK(tilted.rms / levelled.rms == about(3, 5e-3));
    // About the centroid there is coma and its tilt: the gradient's mean over the disc is 2 W131 y.
    const Wavefront centred =
        wavefront(paraboloid(100, 5), {1e-3}, gauss_rings(12), Removed::nothing, SphereCentre::centroid);
    const Wavefront centred_levelled =
        wavefront(paraboloid(100, 5), {1e-3}, gauss_rings(12), Removed::tilt, SphereCentre::centroid);
    CHECK(centred_levelled.rms == about(levelled.rms, 1e-3));
    // RMS of r^3 cos - r cos: the mean square is 1/8 - 2/6 + 1/4 = 1/24, over 1/72 without the tilt.
    CHECK(centred.rms / levelled.rms == about(std::sqrt(3), 5e-3));
}

namespace {

/// The optical path difference of one ray in fifty digits: every length whole, from the object to the sphere.
class ManyDigits {
public:
    ManyDigits(const LensSystem& lens, const FieldPoint& field, const Wavefront& w)
        : lens_(lens), object_(lens, lens.wavelength_nm, field), index_(lens.indices(lens.wavelength_nm).back()) {
        // Rays on the very edge of the stop pass.
        lens_.surfaces[static_cast<std::size_t>(lens.stop_index())].clear_semi_diameter *= 2;
        lens_.stop_semi_diameter *= 1.001;
        const OracleRay chief = traced(w.rays.chief.entry);
        const Real z = Real(lens.last_vertex()) + lens.film_distance;
        centre_ = chief.origin + ((z - chief.origin.z) / chief.direction.z) * chief.direction;
        radius_ = field.angle_rad == 0 ? 1 / Real(w.reference_curvature) : Real(centre_.y / chief.direction.y);
        reference_ = path(w.rays.chief.entry);
    }
    double operator()(ObjectPoint::Entry entry) const {
        return static_cast<double>((reference_ - path(entry)) * Real(1e6) / lens_.wavelength_nm);
    }

private:
    OracleRay traced(ObjectPoint::Entry entry) const {
        return oracle_trace(lens_, LightDirection::to_film, object_.at(entry), object_.direction(entry));
    }
    Real path(ObjectPoint::Entry entry) const {
        const OracleRay ray = traced(entry);
        REQUIRE(ray.status == RayStatus::ok);
        // From the object: the entry plane is across the light from infinity.
        Real before = 0;
        if (object_.inverse_distance != 0) {
            const RealVector from =
                exact(object_.centre) - (1 / Real(object_.inverse_distance)) * exact(object_.towards);
            before = length(exact(object_.at(entry)) - from);
        }
        const RealVector b = ray.origin - centre_;
        const Real along = dot(b, ray.direction), root = sqrt(along * along - dot(b, b) + radius_ * radius_);
        return before + ray.optical_path + index_ * (radius_ > 0 ? Real(-along - root) : Real(-along + root));
    }

    LensSystem lens_;
    ObjectPoint object_;
    Real index_, radius_, reference_;
    RealVector centre_;
};

}  // namespace

TEST_CASE("optical path differences agree with the same rays in fifty digits") {
    double worst = 0, worst_naive = 0;
    int tried = 0;
    for (const std::string name : {"double-gauss-100mm", "phone-4mm", "mirror-telephoto-500mm", "fisheye-6mm-220deg",
                                   "telephoto-200mm-inner-focus", "wide-22mm"}) {
        CAPTURE(name);
        LensSystem lens = io::read_lens(name);
        for (Surface& s : lens.surfaces) s.inner_semi_diameter = 0;  // the chief ray is to pass
        const double f = std::fabs(first_order(lens, lens.wavelength_nm).effective_focal_length);
        // 30 focal lengths, a kilometre, a thousand kilometres, infinity.
        for (const double object : {30 * f, 1e6, 1e9, kInfinity})
            for (const double height : {0.0, 0.3}) {
                // The oracle looks for an asphere where the ray passes the axis, too far from here.
                if (name == "phone-4mm" && std::isfinite(object) && object > 1e3) continue;
                const FieldPoint field{
                    name.starts_with("fisheye") ? 4 * height : std::atan(height * lens.film_height / f), object};
                const Wavefront w = wavefront(lens, field, hexapolar(2));
                const ManyDigits exactly(lens, field, w);
                const ObjectPoint from(lens, lens.wavelength_nm, field);
                for (std::size_t i = 0; i < w.opd.size(); ++i) {
                    if (!w.rays.passes(i)) continue;
                    const double error = w.opd[i] - exactly(w.rays.rays[i].entry);
                    worst = std::max(worst, std::fabs(error));
                    ++tried;
                    if (!std::isfinite(object)) continue;
                    // Error of the difference of the full distances from the object in double precision.
                    const double distance = 1 / from.inverse_distance;
                    const ObjectPoint::Entry e = w.rays.rays[i].entry, c = w.rays.chief.entry;
                    const double q = std::hypot(e.x, e.y), p = std::hypot(c.x, c.y);
                    const double naive = std::hypot(distance, q) - std::hypot(distance, p);
                    const double careful = from.path_difference(e) - from.path_difference(c);
                    const double change = (naive - careful) * 1e6 / lens.wavelength_nm;
                    worst_naive = std::max(worst_naive, std::fabs(error - change));
                }
            }
    }
    CHECK(tried > 500);
    const std::string rays = std::to_string(tried) + " rays of six lenses, objects from 30 focal lengths to infinity";
    hold({"Truth", "optical path differences against the same rays in fifty digits", rays, "core", "float64", worst,
          1e-6, "waves"});
    breaks(
        {"Truth", "the same with whole lengths from the object", rays, "core", "float64", worst_naive, 1e-6, "waves"});
}

TEST_CASE("the reference sphere may be a plane") {
    // A thin lens with its stop in the front focus: telecentric on the film's side.
    LensSystem lens =
        lens_of({stop_plane(100, 3), refracting(50, 0, Glass::constant(1.5), 20), refracting(0, 0, Glass::air(), 20)});
    lens.film_distance = 100;
    const Wavefront axial = wavefront(lens, {}, gauss_rings(6));
    CHECK(std::fabs(axial.reference_curvature) < 1e-15);
    CHECK(std::isfinite(axial.rms));
    CHECK(std::fabs(wavefront(lens, {0.02}, gauss_rings(6)).reference_curvature) < 1e-4);
}

TEST_CASE("wavefronts that do not exist are refused") {
    LensSystem lens = io::read_lens("double-gauss-50mm");
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    lens.film_distance = data.exit_pupil_position - lens.last_vertex();
    CHECK_THROWS_AS(wavefront(lens, {}, hexapolar(4)), InputError);
    CHECK_THROWS_AS(wavefront(lens, {0.1}, hexapolar(4)), InputError);
    lens = io::read_lens("double-gauss-50mm");
    CHECK_THROWS_AS(wavefront(lens, {1.3}, hexapolar(4)), InputError);
    CHECK_THROWS_AS(wavefront(lens, {}, {{0, 0, 1}, {0, 0.5, 1}}, Removed::focus), InputError);
}
