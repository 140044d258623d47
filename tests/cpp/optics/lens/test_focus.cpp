// Focusing and stopping down: states, travels and refusals. test_hard_focus.cpp has where light is sharpest.

#include <cmath>
#include <limits>
#include <string>

#include "about.hpp"
#include "doctest/doctest.h"
#include "optics/centred_lenses.hpp"
#include "refusal.hpp"
#include "traced_ray.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

// Biconvex, nearly thin, so slow that only paraxial rays pass.
LensSystem nearly_thin_lens() {
    return lens_of(
        {stop_plane(0, 0.25), refracting(100, 0.001, Glass::constant(1.5), 5), refracting(-100, 0, Glass::air(), 5)});
}

}  // namespace

TEST_CASE("refocusing forgets where the lens was focused before") {
    for (const char* name : {"double-gauss-50mm", "telephoto-200mm-inner-focus"}) {
        const LensSystem lens = focused(io::read_lens(name), kInfinity);
        const LensSystem direct = focused(lens, 5000), detour = focused(focused(lens, 2600), 5000);
        // Both bisections end within rounding of the same root; the object-to-film distance is accurate to 1e-9 of 5 m.
        CHECK(std::fabs(direct.film_distance - detour.film_distance) < 1e-5);
        CHECK(std::fabs(direct.surfaces[12 % direct.surfaces.size()].thickness -
                        detour.surfaces[12 % detour.surfaces.size()].thickness) < 1e-5);
    }
}

TEST_CASE("inner focusing moves the group by the patent's travel, and nothing else") {
    // JP H01-102413, example 1: 14.49 mm for an object 2.4996 m from the film (d10 = 21.00 to 35.49).
    LensSystem lens = focused(io::read_lens("telephoto-200mm-inner-focus"), kInfinity);
    lens.focusing.nearest_mm = 0;
    const LensSystem near = focused(lens, 2499.6);
    const double travel = near.surfaces[9].thickness - lens.surfaces[9].thickness;
    // The patent's are paraxial; here both ends are best focus of f/1.86, whose depth of focus of 2 lambda
    // N^2 = 0.004 mm and spherical aberration of a few hundredths the group's sensitivity of about 2.5
    // divides.
    CHECK(travel == about(14.49, 0.01));
    CHECK(near.surfaces[12].thickness - lens.surfaces[12].thickness == about(-travel, 1e-12));
    CHECK(near.film_distance == lens.film_distance);
    CHECK(near.last_vertex() == about(lens.last_vertex(), 1e-14));
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i)
        if (i != 9 && i != 12) CHECK(near.surfaces[i].thickness == lens.surfaces[i].thickness);
}

TEST_CASE("a stopped-down lens is focused as it is wide open") {
    const LensSystem lens = io::read_lens("double-gauss-50mm");
    const LensSystem closed = focused(stopped_down(lens, 11), 2000);
    CHECK(closed.film_distance == focused(lens, 2000).film_distance);
    CHECK(closed.stop_semi_diameter == stopped_down(lens, 11).stop_semi_diameter);
}

TEST_CASE("focus that a lens cannot reach is refused with its reason") {
    const LensSystem thin = nearly_thin_lens();
    // The nearest object-to-film distance of a thin lens is 4 f.
    const std::string near = message_of([&] { focused(thin, 399); });
    CHECK(contains(near, "cannot focus at 0.399 m"));
    CHECK(contains(near, "0.4 m"));
    CHECK(message_of([&] { focused(thin, 400.01); }) == "(no error)");
    const LensSystem inner = io::read_lens("telephoto-200mm-inner-focus");
    CHECK(contains(message_of([&] { focused(inner, 2400); }),
                   "the nearest focus of lens \"telephoto-200mm-inner-focus\" is 2.5 m"));
    LensSystem free = inner;
    free.focusing.nearest_mm = 0;
    CHECK(contains(message_of([&] { focused(free, 400); }), "surfaces 11 to 13"));
    for (const double wrong : {0.0, -1000.0, std::numeric_limits<double>::quiet_NaN(), -kInfinity})
        CHECK(contains(message_of([&] { focused(thin, wrong); }), "expected a positive distance or inf"));
    const LensSystem diverging =
        lens_of({stop_plane(0, 2), refracting(-50, 1, Glass::constant(1.5), 5), refracting(50, 0, Glass::air(), 5)});
    CHECK(contains(message_of([&] { focused(diverging, kInfinity); }), "no real image"));
    CHECK(message_of([&] { focused(diverging, 2000); }) != "(no error)");
}

TEST_CASE("stopping down divides the entrance pupil by the f-number") {
    for (const std::string& name : centred_lens_names()) {
        CAPTURE(name);
        const LensSystem lens = io::read_lens(name);
        const FirstOrder open = first_order(lens, lens.wavelength_nm);
        for (const double f_number : {11.0, 16.0, 22.0}) {
            const FirstOrder data = first_order(stopped_down(lens, f_number), lens.wavelength_nm);
            CHECK(data.f_number == about(f_number, 1e-12));
            CHECK(data.entrance_pupil_diameter * f_number == about(std::fabs(open.effective_focal_length), 1e-12));
            CHECK(data.entrance_pupil_position == open.entrance_pupil_position);
        }
        // The diaphragm opens again.
        CHECK(stopped_down(stopped_down(lens, 22), 11).stop_semi_diameter == stopped_down(lens, 11).stop_semi_diameter);
    }
}

TEST_CASE("focusing and stopping down commute: an f-number is that of the lens at infinity") {
    const LensSystem far = io::read_lens("telephoto-200mm-inner-focus");
    const LensSystem near = focused(far, 3000);
    // The moving group changes the lens: its f-number as focused differs from the engraved one.
    CHECK(first_order(near, kLineD_nm).f_number < 0.99 * first_order(far, kLineD_nm).f_number);
    CHECK(f_number_at_infinity(near) == about(first_order(far, kLineD_nm).f_number, 1e-6));
    const LensSystem a = stopped_down(near, 4), b = focused(stopped_down(far, 4), 3000);
    CHECK(a.stop_semi_diameter == about(b.stop_semi_diameter, 1e-6));
    CHECK(f_number_at_infinity(a) == about(4.0, 1e-6));
    CHECK(stopped_down(near, f_number_at_infinity(far)).is_wide_open());
}

TEST_CASE("an f-number faster than the lens, or none at all, is refused") {
    const LensSystem lens = io::read_lens("double-gauss-50mm");  // f/2.03
    const std::string fast = message_of([&] { stopped_down(lens, 1.4); });
    CHECK(contains(fast, "f/1.4 is faster than lens \"double-gauss-50mm\""));
    CHECK(contains(fast, "f/2.03"));
    CHECK(stopped_down(lens, 2.03).is_wide_open());  // as engraved, of 2.0316...
    for (const double wrong : {0.0, -5.6, kInfinity, std::numeric_limits<double>::quiet_NaN()})
        CHECK(contains(message_of([&] { stopped_down(lens, wrong); }), "expected a positive number"));
}
