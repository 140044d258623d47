#pragma once
#include <array>
#include <vector>

#include "../../math/least_squares.hpp"
#include "../prescription/known_wavelengths.hpp"
#include "index_cubic.hpp"
#include "lens_path.hpp"

namespace REALCAM_NAMESPACE {

/// Returns the variable that runs from 1 at the first to -1 at the last wavelength of the range; constantly 0 if the
/// range is a single wavelength.
WavelengthVariable variable_over(WavelengthRange range);

/// Returns the surfaces, counted from 1, whose glass has one refractive index for all wavelengths.
std::vector<int> non_dispersive_surfaces(const LensSystem& lens);

/// Throws InputError if a glass is not known at all wavelengths of the range, or if the film lies in a dispersive
/// glass: the measure of directions on the film would then differ between wavelengths.
void check_dispersion(const LensSystem& lens, WavelengthRange range);

/// Fits a cubic of the wavelength to `value_of(crossing, indices)` for each crossing of an optical path, in the order
/// of the light. `indices`: result of LensSystem::indices. `wavelengths_nm`: wavelengths of the fit, with equal
/// weights. If they are distributed like the light, the cubics are accurate where most of it is: four times better than
/// cubics that are as accurate at the ends of the spectrum as in its middle. Throws InputError if a glass has no index
/// at a wavelength.
template <class ValueOf>
std::vector<IndexCubic> cubics_over(const LensSystem& lens, const std::vector<Crossing>& crossings,
                                    const std::vector<double>& wavelengths_nm, WavelengthVariable variable,
                                    ValueOf&& value_of) {
    std::vector<double> x;
    std::vector<std::vector<double>> indices;
    for (const double wavelength : wavelengths_nm) {
        x.push_back(static_cast<double>(variable.at(static_cast<float>(wavelength))));
        indices.push_back(lens.indices(wavelength));
    }
    std::vector<IndexCubic> cubics;
    for (const Crossing& crossing : crossings) {
        std::vector<double> values;
        for (const std::vector<double>& n : indices) values.push_back(value_of(crossing, n));
        const std::array<double, 4> c = fit_polynomial<4>(x, values);
        cubics.push_back(
            {{static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2]), static_cast<float>(c[3])}});
    }
    return cubics;
}

/// Fits n'^2 / n^2 - 1 at the crossings of an optical path.
std::vector<IndexCubic> index_cubics(const LensSystem& lens, const std::vector<Crossing>& crossings,
                                     const std::vector<double>& wavelengths_nm, WavelengthVariable variable);

/// Fits n'^2 / n^2 - 1 at the surfaces, for light that passes the whole lens in this direction.
std::vector<IndexCubic> index_cubics(const LensSystem& lens, LightDirection direction,
                                     const std::vector<double>& wavelengths_nm, WavelengthVariable variable);

}  // namespace REALCAM_NAMESPACE
