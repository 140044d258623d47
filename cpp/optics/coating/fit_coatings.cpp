#include "fit_coatings.hpp"

#include <cmath>
#include <numbers>

#include "../trace/lens_dispersion.hpp"

namespace realcam {

namespace fit_coatings_detail {

PolarisedFit fit_cosines(const CoatedSurface& surface, bool is_reflected, double before, double beyond, double lower,
                         double scale) {
    constexpr std::size_t kNodes = 2 * kCosineTerms;
    std::vector<double> x, s, p;
    for (std::size_t j = 0; j < kNodes; ++j) {
        const double cosine = 0.5 + 0.5 * std::cos(std::numbers::pi * (static_cast<double>(j) + 0.5) / kNodes);
        // `lower` is the lower index at the design wavelength; of two nearly equal indices the other may be lower here.
        const double lowest = std::min(before, beyond);
        // Index times cosine in the medium of this index, by Snell's law.
        const auto component_in = [&](double index) {
            return std::sqrt(lowest * lowest * cosine * cosine + (index - lowest) * (index + lowest));
        };
        const double in = component_in(before), out = component_in(beyond);
        const PolarisedResponse response = surface.at(std::min(in / before, 1.0));
        const auto power = [&](const SurfaceResponse& polarised) {
            if (surface.is_mirror()) return polarised.reflectance;
            return is_reflected ? 1 - polarised.reflectance : polarised.transmittance;
        };
        const double quotient = beyond * beyond / (before * before), sum_s = in + out, sum_p = quotient * in + out;
        // Divided by the Fresnel transmittances, which are 1 for a mirror, whose indices are equal on both sides.
        const bool is_mirror = surface.is_mirror();
        x.push_back(scale * component_in(lower) - 1);
        s.push_back(power(response.s) * (is_mirror ? 1 : sum_s * sum_s / (4 * in * out)));
        p.push_back(power(response.p) * (is_mirror ? 1 : sum_p * sum_p / (4 * quotient * in * out)));
    }
    return {fit_polynomial<kCosineTerms>(x, s), fit_polynomial<kCosineTerms>(x, p)};
}

}  // namespace fit_coatings_detail

}  // namespace realcam
