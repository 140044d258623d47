#pragma once
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "../prescription/known_wavelengths.hpp"
#include "index_cubic.hpp"
#include "lens_path.hpp"

namespace REALCAM_NAMESPACE {

WavelengthVariable variable_over(WavelengthRange range);

/// The surfaces, from 1, whose glass has one refractive index for all wavelengths.
std::vector<int> surfaces_with_one_index(const LensSystem& lens);

namespace lens_dispersion_detail {

/// Cubic of x in [-1, 1] through a function that is known at Chebyshev's nodes: the first terms of its series.
template <std::size_t N>
IndexCubic cubic_of(const std::array<double, N>& nodes, const std::array<double, N>& values) {
    double series[4] = {0, 0, 0, 0};
    for (std::size_t j = 0; j < N; ++j) {
        const double x = nodes[j];
        const double polynomial[4] = {0.5, x, 2 * x * x - 1, (4 * x * x - 3) * x};
        for (int m = 0; m < 4; ++m) series[m] += 2.0 / static_cast<double>(N) * polynomial[m] * values[j];
    }
    return {{static_cast<float>(series[0] - series[2]), static_cast<float>(series[1] - 3 * series[3]),
             static_cast<float>(2 * series[2]), static_cast<float>(4 * series[3])}};
}

}  // namespace lens_dispersion_detail

/// Throws InputError where a glass is not known at all of these wavelengths, or the film lies in one that disperses:
/// directions on the film are then another measure at each wavelength.
void check_dispersion(const LensSystem& lens, WavelengthRange range);

/// A cubic for each crossing of a way, in the order in which the light meets them, of `value_of(crossing, indices)`;
/// `indices`: those of LensSystem::indices. Throws InputError where a glass has no index.
template <class ValueOf>
std::vector<IndexCubic> cubics_over(const LensSystem& lens, const std::vector<Crossing>& way, WavelengthRange range,
                                    ValueOf&& value_of) {
    constexpr std::size_t kNodes = 16;
    const WavelengthVariable variable = variable_over(range);
    std::array<double, kNodes> nodes{};
    std::vector<std::vector<double>> indices;
    for (std::size_t j = 0; j < kNodes; ++j) {
        nodes[j] = std::cos(std::numbers::pi * (static_cast<double>(j) + 0.5) / static_cast<double>(kNodes));
        const double scale = static_cast<double>(variable.scale);
        const double wavelength = scale > 0 ? static_cast<double>(WavelengthVariable::kPole_nm) +
                                                  scale / (nodes[j] - static_cast<double>(variable.offset))
                                            : range.first;
        indices.push_back(lens.indices(wavelength));
    }
    std::vector<IndexCubic> cubics;
    for (const Crossing& crossing : way) {
        std::array<double, kNodes> values{};
        for (std::size_t j = 0; j < kNodes; ++j) values[j] = value_of(crossing, indices[j]);
        cubics.push_back(lens_dispersion_detail::cubic_of(nodes, values));
    }
    return cubics;
}

/// What surfaces do to light on a way through the lens.
std::vector<IndexCubic> index_cubics(const LensSystem& lens, const std::vector<Crossing>& way, WavelengthRange range);

/// The cubics for light on its way through the whole lens.
std::vector<IndexCubic> index_cubics(const LensSystem& lens, LightDirection direction, WavelengthRange range);

}  // namespace REALCAM_NAMESPACE
