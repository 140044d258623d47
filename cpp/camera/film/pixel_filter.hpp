#pragma once
#include <cmath>
#include <cstdint>

#include "../../platform.hpp"

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

}  // namespace REALCAM_NAMESPACE
