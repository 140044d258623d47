#pragma once
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "index_cubic.hpp"
#include "known_wavelengths.hpp"
#include "lens_path.hpp"

namespace REALCAM_NAMESPACE {

inline WavelengthVariable variable_over(WavelengthRange range) {
    const auto pole = static_cast<double>(WavelengthVariable::kPole_nm);
    const double low = 1 / (range.last - pole), high = 1 / (range.first - pole);
    if (!(high - low > 1e-9)) return {0, 0};
    return {static_cast<float>(2 / (high - low)), static_cast<float>(-(high + low) / (high - low))};
}

/// The surfaces, from 1, whose glass has one refractive index for all wavelengths.
inline std::vector<int> surfaces_with_one_index(const LensSystem& lens) {
    std::vector<int> found;
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
        const Surface& surface = lens.surfaces[i];
        if (surface.type == SurfaceType::refracting && !surface.material.is_air() && surface.material.has_one_index())
            found.push_back(static_cast<int>(i) + 1);
    }
    return found;
}

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
inline void check_dispersion(const LensSystem& lens, WavelengthRange range) {
    check_glasses_known(lens, range, "dispersion");
    const Glass* last = nullptr;
    for (const Surface& surface : lens.surfaces)
        if (surface.type == SurfaceType::refracting) last = &surface.material;
    if (last && !last->has_one_index())
        throw InputError("dispersion: the film of " + lens.name +
                         " lies in glass; a lens with air behind its last surface is wanted");
}

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
inline std::vector<IndexCubic> index_cubics(const LensSystem& lens, const std::vector<Crossing>& way,
                                            WavelengthRange range) {
    return cubics_over(lens, way, range, [](const Crossing& crossing, const std::vector<double>& indices) {
        const double n = crossing.index_before(indices), behind = crossing.index_behind(indices);
        return (behind - n) * (behind + n) / (n * n);
    });
}

/// Of light on its way through the whole lens.
inline std::vector<IndexCubic> index_cubics(const LensSystem& lens, LightDirection direction, WavelengthRange range) {
    const std::vector<Crossing> to_film = crossings_of(lens);
    return index_cubics(lens, direction == LightDirection::to_film ? to_film : reversed(to_film), range);
}

}  // namespace REALCAM_NAMESPACE
