// First-order data against the printed figures of lens-design programs and against closed forms.

#include <cmath>
#include <string>
#include <vector>

#include "about.hpp"
#include "doctest/doctest.h"
#include "optics/centred_lenses.hpp"
#include "optics/code_v_aberrations.hpp"
#include "optics/lens/paraxial.hpp"
#include "traced_ray.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

// Half a unit of the last printed digit.
constexpr double kFourDigits = 0.5e-4;

// The program's last digits and the formulas of the glasses leave a hundredth of it.
template <class Figure>
void check_printed(const LensSystem& lens, Figure&& figure, double printed, double half_digit) {
    CHECK(std::fabs(figure(first_order(lens, lens.wavelength_nm)) - printed) <= 1.02 * half_digit);
}

LensSystem stopped_to_rim(LensSystem lens, double semi_diameter) {
    lens.stop_semi_diameter = semi_diameter;
    return lens;
}

}  // namespace

// CODE V 10.8, listing of "Double Gauss F/2 - Available Glasses" (ag_dblgauss.lis of ray-optics), 587.6 nm.
TEST_CASE("first-order data of the CODE V double Gauss to the printed digits") {
    const LensSystem lens = io::read_lens("double-gauss-100mm");
    REQUIRE(lens.wavelength_nm == 587.6);
    check_printed(lens, [](const FirstOrder& d) { return d.effective_focal_length; }, 100.0038, kFourDigits);
    check_printed(lens, [](const FirstOrder& d) { return d.back_focal_distance; }, 61.4875, kFourDigits);
    check_printed(lens, [](const FirstOrder& d) { return d.front_focal_distance; }, -29.3208, kFourDigits);
    check_printed(lens, [](const FirstOrder& d) { return d.f_number; }, 2.0001, kFourDigits);
    check_printed(lens, [](const FirstOrder& d) { return d.entrance_pupil_diameter; }, 50.0000, kFourDigits);
    check_printed(lens, [](const FirstOrder& d) { return d.entrance_pupil_position; }, 57.9120, kFourDigits);
    check_printed(lens, [](const FirstOrder& d) { return d.exit_pupil_diameter; }, 57.3201, kFourDigits);
    const double last = lens.last_vertex();
    CHECK(last == about(77.9674, kFourDigits / 78));
    check_printed(lens, [&](const FirstOrder& d) { return d.exit_pupil_position - last; }, -53.1569, kFourDigits);
}

// The same listing, command FIO: marginal ray (height 25) and chief ray (14 degrees, through the middle of the entrance
// pupil).
TEST_CASE("paraxial rays of the CODE V double Gauss, surface by surface") {
    const std::vector<CodeVParaxial> rows = code_v_paraxial();
    const LensSystem lens = io::read_lens("double-gauss-100mm");
    REQUIRE(rows.size() == lens.surfaces.size());
    const double pupil = first_order(lens, lens.wavelength_nm).entrance_pupil_position;
    const double tangent = std::tan(14.0000000032 * M_PI / 180);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        CAPTURE(i + 1);
        const int last = static_cast<int>(i) + 1;
        const ParaxialRay marginal = trace_paraxial(lens, lens.wavelength_nm, {25, 0}, 0, last);
        const ParaxialRay chief = trace_paraxial(lens, lens.wavelength_nm, {-pupil * tangent, tangent}, 0, last);
        // Half a unit of the last digit.
        CHECK(std::fabs(marginal.height - rows[i].marginal_height) < 0.51e-6);
        CHECK(std::fabs(marginal.slope - rows[i].marginal_slope) < 0.51e-6);
        CHECK(std::fabs(chief.height - rows[i].chief_height) < 0.51e-6);
        CHECK(std::fabs(chief.slope - rows[i].chief_slope) < 0.51e-6);
    }
}

// Computed from the published tables by two programs that agree; lenses with one index a glass, so nothing
// but the printed digits is uncertain. Sources of the tables: the lens files.
TEST_CASE("four classic prescriptions to the printed digits") {
    struct Printed {
        std::string name;
        double focal_length, back_focal_distance, f_number;
    };
    for (const Printed& p :
         {Printed{"double-gauss-50mm", 50.3582, 36.1059, 2.03}, Printed{"wide-22mm", 22.0235, 14.3183, 2.68},
          Printed{"fisheye-10mm", 9.9914, 23.1605, 3.95}, Printed{"telephoto-250mm", 249.5666, 105.0704, 5.42}}) {
        CAPTURE(p.name);
        const FirstOrder data = first_order(io::read_lens(p.name), kLineD_nm);
        CHECK(std::fabs(data.effective_focal_length - p.focal_length) <= kFourDigits);
        CHECK(std::fabs(data.back_focal_distance - p.back_focal_distance) <= kFourDigits);
        CHECK(std::fabs(data.f_number - p.f_number) <= 0.5e-2);
    }
}

// Published runs of OpticStudio.
TEST_CASE("the double Gauss at f/5 and the singlet as OpticStudio has them") {
    const LensSystem lens = io::read_lens("double-gauss-100mm");
    // The stop's radius follows the entrance pupil's, 20.00075 to 50.
    const LensSystem at_f5 = stopped_to_rim(lens, lens.stop().clear_semi_diameter * 20.00075 / 50);
    // OpticStudio's glasses are those of the listing within an index of 1e-7, as catalogues round their coefficients:
    // 1e-5.
    check_printed(at_f5, [](const FirstOrder& d) { return d.effective_focal_length; }, 100.003748, 1e-5);
    check_printed(at_f5, [](const FirstOrder& d) { return d.f_number; }, 5.0, 0.5e-4);
    check_printed(at_f5, [](const FirstOrder& d) { return d.entrance_pupil_position; }, 57.912, 0.5e-3);
    // Half a digit of its own, and half a digit of the entrance pupil, 23 / 20 times larger.
    check_printed(at_f5, [](const FirstOrder& d) { return d.exit_pupil_diameter; }, 22.92889, 1.1e-5);
    const double image = lens.last_vertex() + 61.4875364179821;  // paraxial, where the program measures from
    check_printed(at_f5, [&](const FirstOrder& d) { return d.exit_pupil_position - image; }, -114.6444, kFourDigits);

    const FirstOrder singlet = first_order(io::read_lens("singlet-100mm"), kLineD_nm);
    // The index is a fit of the maker's power series, within 5e-6 as the catalogue states: 1e-5 of n - 1 =
    // 0.69.
    CHECK(singlet.effective_focal_length == about(101.501826, 1e-5));
    CHECK(singlet.f_number == about(4.060073, 1e-5));
    // The stop is the last plane, so it is the exit pupil itself; its radius is given with six digits.
    CHECK(singlet.exit_pupil_diameter == about(23.39711, 5e-6));
}

TEST_CASE("a thick lens has the lensmaker's focal length and focal distances") {
    for (const double n : {1.4, 1.5168, 1.9})
        for (const double r1 : {50.0, -80.0, 120.0})
            for (const double r2 : {-60.0, 75.0, -400.0})
                for (const double d : {0.5, 8.0, 30.0}) {
                    const LensSystem lens = lens_of({refracting(r1, d, Glass::constant(n), 5),
                                                     refracting(r2, 0, Glass::air(), 5), stop_plane(0, 5)});
                    const double power = (n - 1) * (1 / r1 - 1 / r2 + (n - 1) * d / (n * r1 * r2));
                    const FirstOrder data = first_order(lens, kLineD_nm);
                    // Rounding of some ten operations in double precision, where the powers may nearly
                    // cancel.
                    CHECK(data.effective_focal_length == about(1 / power, 1e-12));
                    const double back = (1 - (n - 1) * d / (n * r1)) / power;
                    CHECK(data.back_focal_distance == about(back, 1e-12));
                    const double front = -(1 + (n - 1) * d / (n * r2)) / power;
                    CHECK(data.front_focal_distance == about(front, 1e-12));
                }
}

TEST_CASE("a Cassegrain telescope has the focal length of two separated mirrors") {
    // f1 = 200 (concave), f2 = -75 (convex), 150 apart: 1/f = 1/f1 + 1/f2 - d/(f1 f2) = 1/600, and the image
    // lies f (1 - d/f1) = 150 behind the secondary.
    Surface primary = refracting(-400, -150, Glass::air(), 30), secondary = refracting(-150, 0, Glass::air(), 10);
    primary.type = secondary.type = SurfaceType::mirror;
    const LensSystem lens = lens_of({stop_plane(150, 30), primary, secondary});
    const FirstOrder data = first_order(lens, kLineD_nm);
    CHECK(data.effective_focal_length == about(600, 1e-13));
    CHECK(data.back_focal_distance == about(150, 1e-13));
    CHECK(data.f_number == about(10, 1e-13));
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

TEST_CASE("the Lagrange invariant is the same at every surface") {
    for (const std::string& name : centred_lens_names()) {
        CAPTURE(name);
        const LensSystem lens = io::read_lens(name);
        const std::vector<double> n = lens.indices(lens.wavelength_nm);
        const ParaxialRay a{0.7, 0.02}, b{-0.3, 0.11};
        const double before = a.height * b.slope - b.height * a.slope;
        double sign = 1;
        for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
            if (lens.surfaces[i].type == SurfaceType::mirror) sign = -sign;
            const int last = static_cast<int>(i) + 1;
            const ParaxialRay p = trace_paraxial(lens, lens.wavelength_nm, a, 0, last);
            const ParaxialRay q = trace_paraxial(lens, lens.wavelength_nm, b, 0, last);
            // Rounding, of products that may be larger than their difference.
            const double scale = std::fabs(p.height * q.slope) + std::fabs(q.height * p.slope) + before;
            CHECK(std::fabs(sign * n[i + 1] * (p.height * q.slope - q.height * p.slope) - before) < 1e-12 * scale);
        }
    }
}
