#pragma once
#include <algorithm>
#include <array>
#include <vector>

#include "../../math/least_squares.hpp"
#include "coated_surface.hpp"
#include "coating_polynomials.hpp"

namespace REALCAM_NAMESPACE {

namespace fit_coatings_detail {

/// Coefficients of a polynomial in the scaled cosine, at one wavelength.
using CosineFit = std::array<double, kCosineTerms>;
struct PolarisedFit {
    CosineFit s{}, p{};
};

/// Fits the polynomials of CoatingPolynomials at one wavelength. `is_reflected`: the light is reflected at a refracting
/// surface; 1 - reflectance takes the part of the transmittance. `before`, `beyond`, `lower`: indices of the medium of
/// the incident light, of that on the other side, and of the one in which the cosine is measured. `scale`: see
/// CoatingPolynomials.
PolarisedFit fit_cosines(const CoatedSurface& surface, bool is_reflected, double before, double beyond, double lower,
                         double scale);

}  // namespace fit_coatings_detail

/// Fits the coating polynomials of the surfaces along an optical path, in the order of the light. At a stop they are
/// the constant 1. For surfaces that reflect light which they could transmit, see GhostCoating. `wavelengths_nm`:
/// fitted with equal weights; a single one if kWavelengthTerms is 1. `variable`: the WavelengthVariable of the
/// spectrum. Unknown coatings are treated as in CoatedSurface. Throws InputError if an index is unknown.
template <int kWavelengthTerms>
std::vector<CoatingPolynomials<kWavelengthTerms>> fit_coatings(const LensSystem& lens,
                                                               const std::vector<Crossing>& crossings,
                                                               const std::vector<double>& wavelengths_nm,
                                                               WavelengthVariable variable = {0, 0}) {
    using namespace fit_coatings_detail;
    std::vector<CoatingPolynomials<kWavelengthTerms>> fitted(crossings.size());
    const std::vector<double> design = lens.indices(lens.wavelength_nm);
    for (std::size_t k = 0; k < crossings.size(); ++k) {
        const double before = crossings[k].index_before(design), beyond = crossings[k].index_beyond(design);
        fitted[k].scale = static_cast<float>(2 / std::min(before, beyond));
        fitted[k].is_behind = beyond < before;
    }
    std::vector<double> x;
    // For each crossing, the fits at all wavelengths; empty for a stop.
    std::vector<std::vector<PolarisedFit>> fits(crossings.size());
    for (const double wavelength : wavelengths_nm) {
        x.push_back(static_cast<double>(variable.at(static_cast<float>(wavelength))));
        const std::vector<double> indices = lens.indices(wavelength);
        for (std::size_t k = 0; k < crossings.size(); ++k) {
            const auto index = static_cast<std::size_t>(crossings[k].surface);
            if (!lens.surfaces[index].bends_light()) continue;
            const double before = crossings[k].index_before(indices), beyond = crossings[k].index_beyond(indices);
            const CoatedSurface surface =
                coated_surface(lens, index, wavelength,
                               crossings[k].in_order ? LightDirection::to_film : LightDirection::to_scene, indices);
            fits[k].push_back(fit_cosines(surface, crossings[k].is_reflected, before, beyond,
                                          fitted[k].is_behind ? beyond : before, static_cast<double>(fitted[k].scale)));
        }
    }
    // Fits each coefficient of one polarisation as a polynomial of the wavelength variable.
    const auto fit_wavelengths = [&](const std::vector<PolarisedFit>& at_wavelengths,
                                     CosineFit PolarisedFit::* polarisation,
                                     float (&result)[kWavelengthTerms][kCosineTerms]) {
        for (std::size_t i = 0; i < kCosineTerms; ++i) {
            std::vector<double> values;
            for (const PolarisedFit& fit : at_wavelengths) values.push_back((fit.*polarisation)[i]);
            const auto terms = fit_polynomial<kWavelengthTerms>(x, values);
            for (std::size_t j = 0; j < kWavelengthTerms; ++j) result[j][i] = static_cast<float>(terms[j]);
        }
    };
    for (std::size_t k = 0; k < crossings.size(); ++k) {
        if (fits[k].empty()) {
            fitted[k].s[0][0] = fitted[k].p[0][0] = 1;
            continue;
        }
        fit_wavelengths(fits[k], &PolarisedFit::s, fitted[k].s);
        fit_wavelengths(fits[k], &PolarisedFit::p, fitted[k].p);
    }
    return fitted;
}

/// Fits the polynomials for light that passes the whole lens in this direction.
template <int kWavelengthTerms>
std::vector<CoatingPolynomials<kWavelengthTerms>> fit_coatings(const LensSystem& lens, LightDirection direction,
                                                               const std::vector<double>& wavelengths_nm,
                                                               WavelengthVariable variable = {0, 0}) {
    const std::vector<Crossing> to_film = crossings_of(lens);
    return fit_coatings<kWavelengthTerms>(lens, direction == LightDirection::to_film ? to_film : reversed(to_film),
                                          wavelengths_nm, variable);
}

}  // namespace REALCAM_NAMESPACE
