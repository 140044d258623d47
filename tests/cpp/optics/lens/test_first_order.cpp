// First-order data: of lenses that are hard to compute in 50 digits, in closed form, and where a figure is infinite; of
// bundled lenses by Newton's equation. Listings of other programs are compared in tests/truth.

#include <cmath>
#include <string>
#include <vector>

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

/// Rows of a ray matrix in height and index times slope, by powers: (h, n u) -> (A h + B n u, C h + D n u).
struct RealMatrix {
    Real A = 1, B = 0, C = 0, D = 1;

    void refract(const Real& power) { C -= power * A, D -= power * B; }
    void transfer(const Real& reduced) { A += reduced * C, B += reduced * D; }
};

/// Over the surfaces [first, last), from vertex to vertex.
RealMatrix matrix_of(const LensSystem& lens, int first, int last) {
    const std::vector<double> n = lens.indices(lens.wavelength_nm);
    RealMatrix m;
    int direction_sign = 1;
    for (int i = 0; i < last; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const Surface& s = lens.surfaces[k];
        const Real before = direction_sign * Real(n[k]);
        if (s.type == SurfaceType::mirror) direction_sign = -direction_sign;
        const Real behind = direction_sign * Real(n[k + 1]);
        if (i < first) continue;
        m.refract((behind - before) * s.curvature);
        if (i + 1 < last) m.transfer(s.thickness / behind);
    }
    return m;
}

struct Figure {
    std::string name;
    double found;
    Real truth;
};

std::vector<Figure> figures(const LensSystem& lens) {
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    const int count = static_cast<int>(lens.surfaces.size()), stop = lens.stop_index();
    const RealMatrix all = matrix_of(lens, 0, count), to_stop = matrix_of(lens, 0, stop + 1),
                     behind = matrix_of(lens, stop, count);
    const std::vector<double> n = lens.indices(lens.wavelength_nm);
    const Real last_index = n.back(), radius = std::min(lens.stop_semi_diameter, lens.stop().clear_semi_diameter);
    const Real f = -1 / all.C, to_exit = -behind.B * last_index / behind.D;
    Real last = 0;
    for (std::size_t i = 0; i + 1 < lens.surfaces.size(); ++i) last += lens.surfaces[i].thickness;
    const Real entrance = 2 * radius / abs(to_stop.A);
    std::vector<Figure> list = {
        {"entrance pupil", data.entrance_pupil_position, to_stop.B / to_stop.A},
        {"its diameter", data.entrance_pupil_diameter, entrance},
        {"exit pupil", data.exit_pupil_position, last + to_exit},
        {"its diameter", data.exit_pupil_diameter, 2 * radius * abs(behind.A + behind.C * to_exit / last_index)}};
    if (all.C == 0) return list;
    list.push_back({"focal length", data.effective_focal_length, f});
    list.push_back({"back focal distance", data.back_focal_distance, all.A * f * last_index});
    list.push_back({"front focal distance", data.front_focal_distance, -all.D * f});
    list.push_back({"f-number", data.f_number * scale_of(lens), abs(f) / entrance * scale_of(lens)});
    return list;
}

}  // namespace

TEST_CASE("first-order data of hard lenses are those of 50 digits") {
    double worst = 0;
    int count = 0;
    for (const LensGroup& group : hard_lenses())
        for (const HardLens& hard : group.lenses)
            for (const Figure& figure : figures(hard.lens)) {
                CAPTURE(hard.name);
                CAPTURE(figure.name);
                const double size = std::max(scale_of(hard.lens), std::fabs(static_cast<double>(figure.truth)));
                const double error = std::fabs(static_cast<double>(Real(figure.found) - figure.truth)) / size;
                CHECK(error <= 1e-12);
                worst = std::max(worst, error);
                ++count;
            }
    hold({"Lenses", "first-order data: focal length, focal points, pupils, f-number",
          std::to_string(count) + " figures of the lenses above", "core", "float64", worst, 1e-12,
          "of the figure or the lens's length"});
}

TEST_CASE("closed forms: a Cassegrain, f/0.7, attachments that double and halve the focal length") {
    const FirstOrder cassegrain = first_order(Cassegrain::lens(), kLineD_nm);
    CHECK(cassegrain.effective_focal_length == about(Cassegrain::kFocalLength, 1e-13));
    CHECK(cassegrain.back_focal_distance == about(Cassegrain::kBack, 1e-13));
    const FirstOrder fast = first_order(FastLens::lens(), kLineD_nm);
    CHECK(fast.effective_focal_length == about(FastLens::kFocalLength, 1e-14));
    CHECK(fast.f_number == about(0.7, 1e-14));
    const LensSystem gauss = io::read_lens("double-gauss-50mm");
    const FirstOrder alone = first_order(gauss, gauss.wavelength_nm);
    const FirstOrder tele = first_order(in_front(galilean(30, 10), gauss), gauss.wavelength_nm);
    const FirstOrder wide = first_order(in_front(reversed_galilean(30, 10), gauss), gauss.wavelength_nm);
    // The attachments are made of powers of two.
    CHECK(tele.effective_focal_length == 2 * alone.effective_focal_length);
    CHECK(wide.effective_focal_length == 0.5 * alone.effective_focal_length);
    CHECK(tele.back_focal_distance == alone.back_focal_distance);
    CHECK(wide.back_focal_distance == alone.back_focal_distance);
    CHECK(tele.f_number == alone.f_number);
}

TEST_CASE("an afocal system has infinite focal lengths, and no focus or f-number") {
    std::vector<LensSystem> afocal;
    for (std::vector<Surface> surfaces : {galilean(30, 5), reversed_galilean(30, 5), plates(20, 1.1, 20)}) {
        surfaces.push_back(stop_plane(0, 10));
        afocal.push_back(lens_of(surfaces));
    }
    afocal.push_back(lens_of({stop_plane(0, 10)}));
    // With indices and radii that are not powers of two, the computed power is only rounding error.
    for (const double n : {1.5168, 1.62, 1.7})
        for (const double r : {-77.7, -30.1}) {
            const double ocular = r / (n - 1), f = -2.7 * ocular;
            std::vector<Surface> surfaces{
                refracting(f * (n - 1), 0, Glass::constant(n), 20), refracting(0, f + ocular, Glass::air(), 20),
                refracting(r, 0, Glass::constant(n), 10), stop_plane(0, 8), refracting(0, 0, Glass::air(), 10)};
            afocal.push_back(lens_of(surfaces));
        }
    for (const LensSystem& lens : afocal) {
        const FirstOrder data = first_order(lens, lens.wavelength_nm);
        CHECK(data.effective_focal_length == kInfinity);
        CHECK(data.back_focal_distance == kInfinity);
        CHECK(data.front_focal_distance == -kInfinity);
        CHECK(data.f_number == kInfinity);
        CHECK(std::isfinite(data.entrance_pupil_position));
        CHECK(std::isfinite(data.entrance_pupil_diameter));
        CHECK(std::isfinite(data.exit_pupil_position));
        CHECK(std::isfinite(data.exit_pupil_diameter));
        for (const double distance : {500.0, 1e4, kInfinity})
            CHECK(contains(message_of([&] { focused(lens, distance); }), "it is afocal"));
        CHECK(contains(message_of([&] { stopped_down(lens, 8); }), "it is afocal"));
        CHECK_FALSE(std::isfinite(best_focus_distance(lens, lens.wavelength_nm, kInfinity)));
    }
}

TEST_CASE("a stop in a focal plane has its pupil at infinity, and the other figures stay finite") {
    for (const double r : {64.0, 77.7, 50.1}) {
        const double f = r / 0.5168;  // thin, of index 1.5168: the pupil's inverse distance is only rounding error
        const std::vector<Surface> thin{refracting(r, 0, Glass::constant(1.5168), 10),
                                        refracting(0, f, Glass::air(), 10)};
        std::vector<Surface> behind = thin, before{stop_plane(f, 3)};
        behind.push_back(stop_plane(0, 3));
        before.insert(before.end(), thin.begin(), thin.end());
        LensSystem telecentric = lens_of(behind), at_film = lens_of(before);
        at_film.surfaces.back().thickness = 0;
        for (const double radius : {3.0, 0.0}) {
            telecentric.stop_semi_diameter = at_film.stop_semi_diameter = radius;
            const FirstOrder scene_side = first_order(telecentric, kLineD_nm),
                             film_side = first_order(at_film, kLineD_nm);
            CHECK(std::isinf(scene_side.entrance_pupil_position));
            CHECK(scene_side.entrance_pupil_diameter == (radius > 0 ? kInfinity : 0));
            CHECK(scene_side.effective_focal_length == about(f, 1e-14));
            CHECK(std::fabs(scene_side.exit_pupil_diameter - 2 * radius) < 1e-13);
            CHECK(std::isinf(film_side.exit_pupil_position));
            CHECK(film_side.exit_pupil_diameter == (radius > 0 ? kInfinity : 0));
            if (radius > 0)
                CHECK(film_side.f_number == about(f / 6, 1e-14));
            else
                CHECK(film_side.f_number == kInfinity);
        }
        CHECK(contains(message_of([&] { stopped_down(telecentric, 8); }), "has no f-number"));
        CHECK(stopped_down(at_film, f / 2).stop_semi_diameter == about(1, 1e-14));
    }
}

TEST_CASE("object and image distances obey Newton's equation") {
    for (const std::string& name : centred_lens_names()) {
        CAPTURE(name);
        const LensSystem lens = io::read_lens(name);
        const FirstOrder data = first_order(lens, lens.wavelength_nm);
        const double f = data.effective_focal_length;
        for (const double magnification : {0.01, 0.3, 1.0, 4.0}) {
            // x x' = -n' f^2, x and x' from the focal points.
            const double object = -data.front_focal_distance + std::fabs(f) / magnification;
            const double image = data.back_focal_distance + data.image_index * std::fabs(f) * magnification;
            // The image distance is a difference of terms that may be a hundred times larger (far front
            // focus).
            const double found = paraxial_image_distance(lens, lens.wavelength_nm, object);
            CHECK(std::fabs(found - image) < 1e-10 * (std::fabs(image) + std::fabs(f)));
        }
    }
}
