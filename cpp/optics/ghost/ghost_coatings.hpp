#pragma once
#include <vector>

#include "../coating/fit_coatings.hpp"
#include "../trace/lens_dispersion.hpp"
#include "ghost_media.hpp"

namespace REALCAM_NAMESPACE {

/// Returns the coatings at the surface crossings of one or several ghost paths, with the index changes that reflection
/// at a coating requires. `coatings`: fit_coatings of the same crossings; `wavelengths_nm`, `variable`: as in
/// cubics_over, with a single wavelength if kWavelengthTerms is 1. Throws InputError if a glass has no index at one of
/// the wavelengths.
template <int kWavelengthTerms>
std::vector<GhostCoating<kWavelengthTerms>> ghost_coatings(
    const LensSystem& lens, const std::vector<Crossing>& crossings,
    const std::vector<CoatingPolynomials<kWavelengthTerms>>& coatings, const std::vector<double>& wavelengths_nm,
    WavelengthVariable variable = {0, 0}) {
    const auto difference = [](const Crossing& crossing, const std::vector<double>& indices) {
        const double n = crossing.index_before(indices), other = crossing.index_beyond(indices);
        return (other - n) * (other + n);
    };
    const auto change = [&](const Crossing& crossing, const std::vector<double>& indices) {
        const double n = crossing.index_before(indices);
        return difference(crossing, indices) / (n * n);
    };
    const std::vector<IndexCubic> changes = cubics_over(lens, crossings, wavelengths_nm, variable, change);
    const std::vector<IndexCubic> differences = cubics_over(lens, crossings, wavelengths_nm, variable, difference);
    std::vector<GhostCoating<kWavelengthTerms>> all;
    for (std::size_t k = 0; k < crossings.size(); ++k)
        all.push_back({coatings[k], changes[k], differences[k], crossings[k].is_reflected, {}});
    return all;
}

}  // namespace REALCAM_NAMESPACE
