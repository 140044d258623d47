// The polynomials by which pictures know what a coated surface passes on, against the films themselves.

#include <algorithm>
#include <cmath>
#include <string>

#include "camera/effects/dispersion/film_spectrum.hpp"
#include "doctest/doctest.h"
#include "io/lens/lens_file.hpp"
#include "io/lens/lens_text.hpp"
#include "measurement.hpp"
#include "optics/centred_lenses.hpp"
#include "optics/coated_lens.hpp"
#include "optics/coating/coated_surface.hpp"
#include "optics/coating/fit_coatings.hpp"
#include "optics/lens/lens_changes.hpp"
#include "optics/prescription/coating.hpp"
#include "optics/trace/lens_dispersion.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

struct Errors {
    double worst = 0;           ///< largest error at any angle
    double worst_below_73 = 0;  ///< largest error at angles up to 73 degrees, whose cosine is 0.3
    double worst_mirror = 0;    ///< largest error of mirrors, at any angle
};

/// Adds the errors of all surfaces at one wavelength to `errors`.
template <int terms>
void compare(const LensSystem& lens, LightDirection direction, double wavelength_nm,
             const std::vector<CoatingPolynomials<terms>>& fitted, float variable, Errors& errors) {
    const auto surfaces = coated_surfaces(lens, wavelength_nm, direction);
    const LensPath<double> path(lens, direction, wavelength_nm);
    for (std::size_t k = 0; k < fitted.size(); ++k) {
        const SurfaceView<double>& view = path.view().surfaces[k];
        const double before = std::sqrt(view.index_squared);
        const double square_behind = view.index_squared * (1 + view.squared_index_change);
        for (int i = 1; i <= 100; ++i) {
            // Cosine in the medium with the lower index, so that there is no total internal reflection.
            const double cosine = i / 100.0, lower = std::min(before, std::sqrt(square_behind));
            const double component = lower * cosine;
            const double in = std::sqrt(component * component + view.index_squared - lower * lower);
            const double out = std::sqrt(component * component + square_behind - lower * lower);
            const float x = fitted[k].scale * static_cast<float>(fitted[k].is_behind ? out : in) - 1;
            double s = 1, p = 1;
            if (surfaces[k]) {
                const PolarisedResponse response = surfaces[k]->at(std::min(in / before, 1.0));
                s = surfaces[k]->is_mirror() ? response.s.reflectance : response.s.transmittance;
                p = surfaces[k]->is_mirror() ? response.p.reflectance : response.p.transmittance;
            }
            const auto quotient = static_cast<float>(square_behind / view.index_squared);
            const FresnelTransmittance bare =
                fresnel_transmittance(static_cast<float>(in), static_cast<float>(out), quotient);
            const auto error_of = [&](float of_bare, const auto& polynomials, double expected) {
                return std::fabs(static_cast<double>(of_bare * fitted[k].at(polynomials, x, variable)) - expected);
            };
            const double error = std::max(error_of(bare.s, fitted[k].s, s), error_of(bare.p, fitted[k].p, p));
            if (surfaces[k] && surfaces[k]->is_mirror()) {
                errors.worst_mirror = std::max(errors.worst_mirror, error);
                continue;
            }
            errors.worst = std::max(errors.worst, error);
            if (cosine > 0.3) errors.worst_below_73 = std::max(errors.worst_below_73, error);
        }
    }
}

}  // namespace

TEST_CASE("polynomials in the cosine follow all coatings at one wavelength") {
    Errors errors;
    for (const std::string& name : centred_lens_names())
        for (const Coating& coating : {bare_surface(), *named_coating("quarter_wave"), three_layers()})
            for (const LightDirection direction : {LightDirection::to_film, LightDirection::to_scene}) {
                const LensSystem lens = coated(io::read_lens(name), coating);
                compare(lens, direction, lens.wavelength_nm,
                        fit_coatings<kOneWavelengthTerms>(lens, direction, {lens.wavelength_nm}), 0, errors);
            }
    // 1e-4 of the light at each of twenty surfaces is half a code value of 255. Glass of n = 2.0 has an error
    // of 1.3e-4; zoom-11-24mm has one element of it.
    hold({"Effects", "transmittance of a coated surface, up to 73 degrees", "all lenses, 3 coatings", "core", "float32",
          errors.worst_below_73, 1.5e-4, ""});
    hold({"Effects", "transmittance of a coated surface, all angles", "all lenses, 3 coatings", "core", "float32",
          errors.worst, 2e-4, ""});
    // Aluminium turns dark for p within a few degrees of grazing light.
    hold({"Effects", "reflectance of a lens's mirror, all angles", "all lenses, aluminium", "core", "float32",
          errors.worst_mirror, 5e-3, ""});
}

TEST_CASE("polynomials in cosine and wavelength follow all coatings over the spectrum") {
    const FilmSpectrum spectrum{Illuminant()};
    const std::vector<double> wavelengths = spectrum.even_wavelengths();
    const WavelengthVariable variable = variable_over(spectrum.range());
    const auto errors_with = [&](const Coating& coating) {
        Errors errors;
        for (const char* const name : {"double-gauss-100mm", "phone-4mm", "mirror-telephoto-500mm"}) {
            const LensSystem lens = coated(io::read_lens(name), coating);
            const auto fitted = fit_coatings<kSpectrumTerms>(lens, LightDirection::to_scene, wavelengths, variable);
            for (const WavelengthCell& cell : spectrum.cells()) {
                const float nm = 0.5f * (cell.first_nm + cell.last_nm);
                if (nm < 430 || nm > 670) continue;  // where the eye sees a twentieth
                compare(lens, LightDirection::to_scene, static_cast<double>(nm), fitted, variable.at(nm), errors);
            }
        }
        return errors.worst_below_73;
    };
    hold({"Effects", "transmittance of a bare or single-layer surface over the spectrum", "3 lenses, 430 to 670 nm",
          "core", "float32", std::max(errors_with(bare_surface()), errors_with(*named_coating("quarter_wave"))), 3e-4,
          ""});
    // Three layers rise steeply at both ends of the spectrum.
    hold({"Effects", "transmittance of a three-layer surface over the spectrum", "3 lenses, 430 to 670 nm", "core",
          "float32", errors_with(three_layers()), 1e-2, ""});
}

TEST_CASE("what a line of light and a closed range of wavelengths leave of the polynomials") {
    const LensSystem lens = coated(io::read_lens("double-gauss-50mm"), *named_coating("quarter_wave"));
    const FilmSpectrum line{Illuminant::line(450)};
    const auto fitted = fit_coatings<kSpectrumTerms>(lens, LightDirection::to_scene, line.even_wavelengths(),
                                                     variable_over(line.range()));
    Errors errors;
    compare(lens, LightDirection::to_scene, 450, fitted, variable_over(line.range()).at(450), errors);
    CHECK(errors.worst_below_73 < 2e-3);
}
