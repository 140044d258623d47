// Coated surfaces of lenses as other code asks for them: one wavelength, one cosine, either direction of the light.

#include <algorithm>
#include <cmath>

#include "about.hpp"
#include "doctest/doctest.h"
#include "io/lens/lens_file.hpp"
#include "measurement.hpp"
#include "optics/analysis/ray_aiming.hpp"
#include "optics/analysis/transmission.hpp"
#include "optics/centred_lenses.hpp"
#include "optics/coating/coated_surface.hpp"
#include "optics/coating/thin_film.hpp"
#include "optics/lens/focus.hpp"
#include "optics/lens/lens_changes.hpp"
#include "optics/prescription/coating.hpp"
#include "optics/trace/lens_path.hpp"

using namespace realcam;
using namespace realcam::test;

TEST_CASE("what a lens does not say of its coatings is bare glass and perfect mirrors") {
    const LensSystem unknown = io::read_lens("mirror-telephoto-500mm");
    const LensSystem stated = with_coating(with_coating(unknown, bare_surface()), stated_reflectance(1));
    CHECK(surfaces_with_unknown_coating(unknown).size() == 14);
    CHECK(surfaces_with_unknown_coating(stated).empty());
    CHECK(axial_transmittance(unknown, 550) == axial_transmittance(stated, 550));
    CHECK(t_stop(unknown, 550) == t_stop(stated, 550));
}

// A disc of 18.51 in an opening of 37.2403, both in parallel light, would leave 1 - 0.247 of the area; the hole of the
// primary mirror, on which the light comes converging, is the larger shadow.
TEST_CASE("a central obstruction is found to all digits") {
    LensSystem lens = io::read_lens("mirror-telephoto-500mm");
    const double share = unobstructed_share(lens, lens.wavelength_nm);
    CHECK(share < 1 - 18.51 * 18.51 / (37.2403 * 37.2403));
    const RayAimer aim(lens, lens.wavelength_nm, FieldPoint{0, kInfinity});
    const double edge = 37.2403 * std::sqrt(1 - share);
    CHECK(aim({edge * (1 + 1e-8), 0}).status == RayStatus::ok);
    CHECK(aim({edge * (1 - 1e-8), 0}).status == RayStatus::vignetted);
    // Open, the rim of its third face takes 1.3% of the beam.
    const LensSystem gauss = io::read_lens("double-gauss-50mm");
    CHECK(unobstructed_share(gauss, kLineD_nm) < 0.99);
    CHECK(unobstructed_share(stopped_down(gauss, 2.8), kLineD_nm) == 1);
}
