#pragma once
#include <bit>
#include <cmath>

#include "random.hpp"
#include "sincos.hpp"

namespace REALCAM_NAMESPACE {

/// Natural logarithm of a normal positive float, to 2e-7 of its value or of 1. Plain arithmetic, so that lane loops
/// with it become vector code.
REALCAM_INLINE float log_of_positive(float v) {
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(v);
    // Mantissa in [sqrt(1/2), sqrt(2)), where the series below converges fast, and 1 has the logarithm 0.
    const std::int32_t exponent = static_cast<std::int32_t>(bits - 0x3f3504f3u) >> 23;
    const float m = std::bit_cast<float>(bits - (static_cast<std::uint32_t>(exponent) << 23));
    const float s = (m - 1.0f) / (m + 1.0f), s2 = s * s;
    // 2 atanh(s); the first term left out is 5e-10.
    const float series = 1.0f + s2 * (1.0f / 3 + s2 * (1.0f / 5 + s2 * (1.0f / 7 + s2 * (1.0f / 9))));
    return static_cast<float>(exponent) * 0.6931471806f + 2.0f * s * series;
}

/// Converts 32 random bits to a float in (0, 1], with a fine resolution also near 0: its logarithm reaches into the
/// tails of the normal distribution.
REALCAM_INLINE float positive_unit_float(std::uint32_t bits) {
    return (static_cast<float>(static_cast<std::int32_t>(bits >> 1)) + 0.5f) * 0x1p-31f;
}

/// Returns two independent standard normal numbers from 64 random bits (Box and Muller 1958), up to 6.7 in magnitude.
REALCAM_INLINE Vec2f normal_pair(std::uint32_t radius_bits, std::uint32_t angle_bits) {
    const float radius = sqrt_or_zero(-2.0f * log_of_positive(positive_unit_float(radius_bits)));
    const Vec2f direction = cos_sin_of_turn(unit_float(angle_bits));
    return {radius * direction.x, radius * direction.y};
}

/// Density of each number of normal_pair.
REALCAM_INLINE float normal_pdf(float x) {
    return 0.3989422804f * std::exp(-0.5f * x * x);
}

}  // namespace REALCAM_NAMESPACE
