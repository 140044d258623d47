#pragma once
#include <cmath>
#include <cstdint>

#include "../../math/lanes.hpp"

namespace REALCAM_NAMESPACE {

/// Reconstruction filter of a picture's pixels: a product of two functions of the distances from the pixel's centre
/// along columns and rows, in pixels. Its integral is 1.
enum class PixelFilter : std::int32_t {
    box,  ///< the pixel's own area
    tent,  ///< falls linearly to 0 at the distance of one pixel
    gaussian,  ///< standard deviation of half a pixel, less a constant with which it is 0 from 1.5 pixels on
};

namespace pixel_filter_detail {

inline constexpr float kGaussianRadius = 1.5f;
inline constexpr float kInverseVariance = 4.0f;
/// exp(-9 / 2), the value of the Gaussian at its radius.
inline constexpr float kGaussianEdge = 0.011108996538f;
/// Inverse of sqrt(pi / 2) erf(3 / sqrt(2)) - 3 exp(-9 / 2), the integral of the Gaussian less its value at the edge.
inline constexpr float kGaussianScale = 0.8219605129f;

}  // namespace pixel_filter_detail

/// Distance from a pixel's centre beyond which the filter is 0, in pixels.
REALCAM_INLINE constexpr float filter_radius(PixelFilter filter) {
    if (filter == PixelFilter::box) return 0.5f;
    return filter == PixelFilter::tent ? 1.0f : pixel_filter_detail::kGaussianRadius;
}

/// Value of a filter along one axis, and its derivative, per pixel. The derivative of the box, which is infinite at
/// its edges, is 0.
struct FilterValue {
    float value, slope;
};

/// Evaluates a filter along one axis. `x`: distance from the pixel's centre, in pixels.
REALCAM_INLINE FilterValue filter_value(PixelFilter filter, float x) {
    using namespace pixel_filter_detail;
    if (!(std::fabs(x) < filter_radius(filter))) return {0.0f, 0.0f};
    if (filter == PixelFilter::box) return {1.0f, 0.0f};
    if (filter == PixelFilter::tent) return {1.0f - std::fabs(x), x < 0.0f ? 1.0f : -1.0f};
    const float gaussian = std::exp(-0.5f * kInverseVariance * x * x);
    return {kGaussianScale * (gaussian - kGaussianEdge), -kGaussianScale * kInverseVariance * x * gaussian};
}

/// Returns a distance from a pixel's centre along one axis, in pixels, with the density of the filter (filter
/// importance sampling: M. Ernst, M. Stamminger and G. Greiner, "Filter importance sampling", IEEE Symposium on
/// Interactive Ray Tracing 2006). `u`: random number in [0, 1).
REALCAM_INLINE float sample_filter(PixelFilter filter, float u) {
    if (filter == PixelFilter::box) return u - 0.5f;
    const float v = 2.0f * u - 1.0f, tent = 1.0f - std::sqrt(1.0f - std::fabs(v));
    if (filter == PixelFilter::tent) return std::copysign(tent, v);
    // Inverse of the Gaussian's cumulative distribution, as a function of that of the tent: a rational least-squares
    // approximation with an error of 2e-5 pixels.
    const float above = ((0.24550881f * tent - 0.61415184f) * tent - 0.57879036f) * tent + 1.22930061f;
    const float below = ((0.57707921f * tent - 1.40368103f) * tent + 0.01451137f) * tent + 1.0f;
    return std::copysign(tent * above / below, v);
}

/// Values of a filter along one axis at the pixels that light at a film point counts for: those whose filter does not
/// vanish there, at most four.
struct FilterWeights {
    static constexpr int kMost = 4;

    int first;  ///< first column or row
    FilterValue of[kMost];

    /// `position`: of the film point along columns or rows, in pixels from the picture's edge.
    REALCAM_INLINE FilterWeights(PixelFilter filter, float position) {
        const float lowest = position - 0.5f - filter_radius(filter);
        first = static_cast<int>(std::floor(lowest)) + 1;
        for (int i = 0; i < kMost; ++i) of[i] = filter_value(filter, position - 0.5f - static_cast<float>(first + i));
    }
};

/// Column or row for which light at a film point counts, chosen at random, and the factor of that light.
struct FilterChoice {
    int index;
    float weight;
};

/// Chooses a column or row with a probability that is proportional to the value of its filter. Parameters: see
/// FilterWeights; `u`: random number in [0, 1).
REALCAM_INLINE FilterChoice choose_by_filter(PixelFilter filter, float position, float u) {
    const FilterWeights weights(filter, position);
    float sum = 0.0f, below = 0.0f;
    for (const FilterValue& of : weights.of) sum += of.value;
    int chosen = 0;
    for (int i = 0; i + 1 < FilterWeights::kMost; ++i) {
        below += weights.of[i].value;
        chosen += select(u * sum >= below, 1, 0);
    }
    return {weights.first + chosen, sum};
}

}  // namespace REALCAM_NAMESPACE
