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

namespace {

Coating three_layers() {
    const auto layer = [](double index, double waves) {
        const CoatingMaterial film = CoatingMaterial::transparent(Glass::constant(index));
        return CoatingLayer{film, thickness_of_waves(film, waves, 550)};
    };
    CoatingLayer absorbing = layer(1.7, 0.25);
    absorbing.material = CoatingMaterial::constant({1.7, 0.01});
    return layered_coating({layer(1.38, 0.25), layer(2.1, 0.5), absorbing});
}

}  // namespace

// Light in the two directions crosses a surface's films in opposite orders. Both transmittances are equal, with
// absorption too, and light that is neither reflected nor transmitted is absorbed.
TEST_CASE("surfaces of lenses let light through both ways alike and lose none of it") {
    double asymmetry = 0, residue = 0;
    int cases = 0;
    for (const std::string& name : centred_lens_names())
        for (const Coating& coating : {bare_surface(), three_layers()}) {
            const LensSystem lens = with_coating(io::read_lens(name), coating);
            for (const double wavelength : {420.0, 550.0, 690.0}) {
                const std::vector<double> n = lens.indices(wavelength);
                const auto forward = coated_surfaces(lens, wavelength, LightDirection::to_film);
                const auto backward = coated_surfaces(lens, wavelength, LightDirection::to_scene);
                for (std::size_t i = 0; i < forward.size(); ++i) {
                    if (!forward[i] || forward[i]->is_mirror()) continue;
                    const auto& back = backward[forward.size() - 1 - i];
                    for (const double degrees : {0.0, 20.0, 45.0, 80.0}) {
                        const double cosine = std::cos(degrees * std::numbers::pi / 180);
                        const double behind = 1 - (n[i] / n[i + 1]) * (n[i] / n[i + 1]) * (1 - cosine * cosine);
                        const PolarisedResponse there = forward[i]->at(cosine);
                        for (const SurfaceResponse& r : {there.s, there.p})
                            residue = std::max(residue, std::fabs(r.reflectance + r.transmittance + r.absorptance - 1));
                        ++cases;
                        if (behind <= 0) {
                            CHECK(there.s.transmittance == 0);
                            CHECK(there.p.transmittance == 0);
                            continue;
                        }
                        const PolarisedResponse here = back->at(std::sqrt(behind));
                        asymmetry = std::max({asymmetry, std::fabs(there.s.transmittance - here.s.transmittance),
                                              std::fabs(there.p.transmittance - here.p.transmittance)});
                    }
                }
            }
        }
    REQUIRE(cases > 1000);
    const std::string tried = std::to_string(cases) + " surfaces, wavelengths and angles of all lenses";
    hold({"Effects", "R + T + A of lens surfaces", tried, "core", "float64", residue, 1e-12, "of the light"});
    hold({"Effects", "surfaces met from the other side", tried, "core", "float64", asymmetry, 1e-12, "of the light"});
}

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

TEST_CASE("the closed form of a quarter wave, where two interfering beams give more than three times as much") {
    const FilmStack stack{550, 1, {{1.38, 550 / 4.0 / 1.38}}, 1.755};
    const double expected = std::pow((1.755 - 1.38 * 1.38) / (1.755 + 1.38 * 1.38), 2);
    CHECK(expected == about(0.00167, 1e-2));
    CHECK(response_of(stack, 1).s.reflectance == about(expected, 1e-12));
    CHECK(response_of(stack, 1).mean_reflectance() == about(expected, 1e-12));
}
