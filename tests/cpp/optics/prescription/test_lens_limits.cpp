// Numbers that no lens has are refused before a ray meets them: their squares would leave the range of float32.

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "doctest/doctest.h"
#include "optics/prescription/lens_checks.hpp"
#include "refusal.hpp"
#include "traced_ray.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

LensSystem probe() {
    return lens_of({refracting(50, 4, Glass::constant(1.5), 8), stop_plane(1, 6), refracting(-60, 0, Glass::air(), 8)});
}

std::string limit_complaint(const std::function<void(LensSystem&)>& change) {
    LensSystem lens = probe();
    change(lens);
    return message_of<LensFileError>([&] { validate(lens); });
}

}  // namespace

TEST_CASE("lengths, curvatures, conics and coefficients that no lens has are refused") {
    CHECK(limit_complaint([](LensSystem&) {}) == "(no error)");
    CHECK(contains(limit_complaint([](LensSystem& l) { l.surfaces[0].thickness = 1e10; }), "surface 1: the thickness"));
    CHECK(contains(limit_complaint([](LensSystem& l) { l.surfaces[1].clear_semi_diameter = 1e10; }),
                   "surface 2: the clear semi"));
    CHECK(contains(limit_complaint([](LensSystem& l) { l.surfaces[1].clear_semi_diameter = 1e-7; }),
                   "surface 2: the clear semi"));
    CHECK(contains(limit_complaint([](LensSystem& l) { l.surfaces[2].conic = -1e7; }), "surface 3: the conic"));
    CHECK(contains(limit_complaint([](LensSystem& l) { l.surfaces[2].conic = 1e7, l.surfaces[2].curvature = 0; }),
                   "the conic"));
    CHECK(contains(limit_complaint([](LensSystem& l) { l.surfaces[2].conic = -2, l.surfaces[2].curvature = 1e10; }),
                   "curvature"));
    CHECK(contains(limit_complaint([](LensSystem& l) { l.surfaces[0].aspheric = {0, 1e39}; }), "aspheric"));
    CHECK(contains(limit_complaint([](LensSystem& l) { l.surfaces[0].aspheric = {1e10}; }), "aspheric"));
    CHECK(contains(limit_complaint([](LensSystem& l) { l.film_width = 1e10; }), "film"));
    CHECK(contains(limit_complaint([](LensSystem& l) { l.iris.rotation_rad = std::nan(""); }), "iris"));
    // The values of the hard cases of lenses are allowed.
    CHECK(limit_complaint([](LensSystem& l) {
              l.surfaces[0].thickness = 1e8;
              l.surfaces[0].conic = -1e3;
              l.surfaces[2].conic = 1e3, l.surfaces[2].curvature = 1e-12;
              l.surfaces[0].aspheric = {1e-2, -1e-4};
              l.surfaces[1].clear_semi_diameter = 1e-6;
          }) == "(no error)");
}

TEST_CASE("a wavelength at which a glass has no refractive index is refused") {
    LensSystem lens = probe();
    lens.surfaces[0].material = Glass::sellmeier({{1.04, 0.006}, {0.23, 0.02}, {1.01, 103.56}});
    lens.surfaces[0].material.label = "crown";
    CHECK(lens.indices(587.6)[1] > 1.4);
    // Between the poles at 77 and 141 nm, n^2 is negative.
    const auto message = [&](double wavelength) { return message_of([&] { lens.indices(wavelength); }); };
    CHECK(contains(message(140), "surface 1"));
    CHECK(contains(message(140), "crown"));
    CHECK(contains(message(140), "140 nm"));
    CHECK(message(500) == "(no error)");
}
