#pragma once
#include <array>
#include <vector>

#include "../../math/fit_polynomial.hpp"
#include "../prescription/known_wavelengths.hpp"
#include "index_cubic.hpp"
#include "lens_path.hpp"

namespace REALCAM_NAMESPACE {

WavelengthVariable variable_over(WavelengthRange range);

/// The surfaces, from 1, whose glass has one refractive index for all wavelengths.
std::vector<int> surfaces_with_one_index(const LensSystem& lens);

/// Throws InputError where a glass is not known at all of these wavelengths, or the film lies in one that disperses:
/// directions on the film are then another measure at each wavelength.
void check_dispersion(const LensSystem& lens, WavelengthRange range);

/// A cubic for each crossing of a way, in the order in which the light meets them, of `value_of(crossing, indices)`;
/// `indices`: those of LensSystem::indices. `wavelengths_nm`: to be fitted with equal weights. Where they are spread as
/// light is, the cubics are right where most of it is: four times better than cubics that are as good at the ends of
/// the spectrum as in its middle. Throws InputError where a glass has no index.
template <class ValueOf>
std::vector<IndexCubic> cubics_over(const LensSystem& lens, const std::vector<Crossing>& way,
                                    const std::vector<double>& wavelengths_nm, WavelengthVariable variable,
                                    ValueOf&& value_of) {
    std::vector<double> x;
    std::vector<std::vector<double>> indices;
    for (const double wavelength : wavelengths_nm) {
        x.push_back(static_cast<double>(variable.at(static_cast<float>(wavelength))));
        indices.push_back(lens.indices(wavelength));
    }
    std::vector<IndexCubic> cubics;
    for (const Crossing& crossing : way) {
        std::vector<double> values;
        for (const std::vector<double>& at : indices) values.push_back(value_of(crossing, at));
        const std::array<double, 4> c = fit_polynomial<4>(x, values);
        cubics.push_back(
            {{static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2]), static_cast<float>(c[3])}});
    }
    return cubics;
}

/// What surfaces do to light on a way through the lens.
std::vector<IndexCubic> index_cubics(const LensSystem& lens, const std::vector<Crossing>& way,
                                     const std::vector<double>& wavelengths_nm, WavelengthVariable variable);

/// The cubics for light on its way through the whole lens.
std::vector<IndexCubic> index_cubics(const LensSystem& lens, LightDirection direction,
                                     const std::vector<double>& wavelengths_nm, WavelengthVariable variable);

}  // namespace REALCAM_NAMESPACE
