#pragma once
#include <bit>
#include <cmath>
#include <cstdint>

#include "random.hpp"
#include "sincos.hpp"

// Normal and Poisson random numbers.

namespace REALCAM_NAMESPACE {

/// Natural logarithm of a positive, normal float, with an absolute or relative error below 2e-7. It uses only basic
/// arithmetic, so that loops over lanes become vector code.
REALCAM_INLINE float log_of_positive(float v) {
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(v);
    // Mantissa in [sqrt(1/2), sqrt(2)): the series below converges fast, and the logarithm of 1 is exactly 0.
    // 0x3f3504f3 is sqrt(1/2) as a float.
    const std::int32_t exponent = static_cast<std::int32_t>(bits - 0x3f3504f3u) >> 23;
    const float m = std::bit_cast<float>(bits - (static_cast<std::uint32_t>(exponent) << 23));
    const float s = (m - 1.0f) / (m + 1.0f), s2 = s * s;
    // log(m) = 2 atanh(s). The first omitted term is 5e-10.
    constexpr float kLog2 = 0.6931471806f;
    const float series = 1.0f + s2 * (1.0f / 3 + s2 * (1.0f / 5 + s2 * (1.0f / 7 + s2 * (1.0f / 9))));
    return static_cast<float>(exponent) * kLog2 + 2.0f * s * series;
}

/// Converts 32 random bits to a float in (0, 1], with a finer resolution near 0 than unit_float: its logarithm
/// determines the tails of the normal distribution.
REALCAM_INLINE float positive_unit_float(std::uint32_t bits) {
    return (static_cast<float>(static_cast<std::int32_t>(bits >> 1)) + 0.5f) * 0x1p-31f;
}

/// Returns two independent standard normal numbers from 64 random bits (Box and Muller 1958). Their magnitudes are at
/// most 6.7.
REALCAM_INLINE Vec2f normal_pair(std::uint32_t radius_bits, std::uint32_t angle_bits) {
    const float radius = sqrt_or_zero(-2.0f * log_of_positive(positive_unit_float(radius_bits)));
    const Vec2f direction = cos_sin_of_turn(unit_float(angle_bits));
    return {radius * direction.x, radius * direction.y};
}

/// Density of each number of normal_pair: that of the standard normal distribution.
REALCAM_INLINE float normal_pdf(float x) {
    constexpr float kInvSqrt2Pi = 0.3989422804f;  // 1 / sqrt(2 pi)
    return kInvSqrt2Pi * std::exp(-0.5f * x * x);
}

// Poisson sampling without an approximation of the distribution: by inversion for small means, and by transformed
// rejection for large ones (Hoermann 1993, "The transformed rejection method for generating Poisson random variables",
// algorithm PTRS). All numbers are double: counts of up to 1e7 electrons must be exact.

/// Largest mean sampled by inversion, which is faster than rejection up to here. Rejection is valid from 10 on
/// (Hoermann 1993).
inline constexpr double kLargestInvertedMean = 40;

/// Converts 32 random bits to a double in (0, 1).
REALCAM_INLINE double open_unit_double(std::uint32_t bits) {
    // Through a signed integer: AVX2 cannot convert unsigned ones.
    return 0.5 + (static_cast<double>(static_cast<std::int32_t>(bits)) + 0.5) * 0x1p-32;
}

/// One attempt of PTRS.
struct PoissonAttempt {
    double count;      ///< whole number: the result, if the attempt is accepted
    bool is_accepted;  ///< true if the attempt is accepted at once, as are some 9 in 10
    bool is_possible;  ///< false if the attempt is rejected at once; otherwise is_accepted_slowly decides
};

/// Hat function of PTRS for one mean of at least 10. The constants are Hoermann's.
struct PoissonHat {
    double mean, b, a;
    double v_r;  ///< attempts with a v up to this, and u not close to 0 or 1, are accepted at once

    REALCAM_INLINE explicit PoissonHat(double mean_)
        : mean(mean_), b(0.931 + 2.53 * std::sqrt(mean_)), a(-0.059 + 0.02483 * b), v_r(0.9277 - 3.6224 / (b - 2)) {}

    /// Makes an attempt from two random numbers u and v in (0, 1).
    REALCAM_INLINE PoissonAttempt attempt(double u, double v) const {
        const double from_middle = u - 0.5, to_edge = 0.5 - std::fabs(from_middle);
        const double count = std::floor((2 * a / to_edge + b) * from_middle + mean + 0.43);
        const bool accepted = (to_edge >= 0.07) & (v <= v_r);
        const bool possible = (count >= 0) & ((to_edge >= 0.013) | (v <= to_edge));
        return {count, accepted, possible};
    }

    /// Returns true if an attempt is accepted that is possible, but not accepted at once. `count`: the attempt's count.
    REALCAM_HD bool is_accepted_slowly(double count, double u, double v) const {
        const double to_edge = 0.5 - std::fabs(u - 0.5);
        const double inverse_alpha = 1.1239 + 1.1328 / (b - 3.4);
        return std::log(v * inverse_alpha / (a / (to_edge * to_edge) + b)) <=
               count * std::log(mean) - mean - log_factorial(count);
    }

    /// Returns log(k!) for a whole number k, with a relative error below 1e-10: Stirling's series from k = 10 on;
    /// smaller k are raised to 10.
    REALCAM_HD static double log_factorial(double k) {
        constexpr double kHalfLog2Pi = 0.91893853320467274178;  // log(2 pi) / 2
        double product = 1;
        for (; k < 10; ++k) product *= k + 1;
        const double inverse = 1 / k, square = inverse * inverse;
        const double series = inverse * (1.0 / 12 - square * (1.0 / 360 - square * (1.0 / 1260 - square / 1680)));
        return (k + 0.5) * std::log(k) - k + kHalfLog2Pi + series - std::log(product);
    }
};

/// Returns e^-x for x from 0 to 40, with a relative error below 8e-15. It uses only basic arithmetic, so that loops
/// over lanes become vector code.
REALCAM_INLINE double exp_of_negative(double x) {
    constexpr double kLog2 = 0.693147180559945309417;
    const double halvings = std::floor(x / kLog2 + 0.5), r = halvings * kLog2 - x;  // r from -0.35 to 0.35
    double sum = 1;
    REALCAM_UNROLL
    for (int k = 13; k >= 1; --k) sum = 1 + r * (1.0 / k) * sum;
    const auto exponent = static_cast<std::int64_t>(1023 - static_cast<std::int32_t>(halvings));
    return sum * std::bit_cast<double>(exponent << 52);
}

/// Samples N Poisson numbers by inversion, for means below kLargestInvertedMean; counts for others are undefined.
/// `u`: uniform random numbers in (0, 1) of 53 bits. A count is the number of partial sums of the probabilities that
/// are less than u. All lanes iterate until the last one is done. This is faster than one lane after the other, because
/// a step has no division and no divergent branch.
template <int N>
REALCAM_HD void invert_poisson(const double (&mean)[N], const double (&u)[N], double (&count)[N]) {
    constexpr int kMaxCount = 160;  // has a probability of 1e-40 at the largest mean
    alignas(64) double probability[N], remaining[N];  // remaining: u minus the partial sum
    REALCAM_LANES
    for (int k = 0; k < N; ++k) {
        const double m = mean[k] < kLargestInvertedMean ? mean[k] : 0.0;
        probability[k] = exp_of_negative(m);
        remaining[k] = m > 0.0 ? u[k] - probability[k] : 0.0;
        count[k] = 0;
    }
    for (int step = 1; step < kMaxCount; ++step) {
        const double inverse = 1.0 / step;
        double unfinished = 0;
        REALCAM_LANES
        for (int k = 0; k < N; ++k) {
            const double increment = remaining[k] > 0.0 ? 1.0 : 0.0;
            count[k] += increment;
            unfinished += increment;
            probability[k] *= mean[k] * inverse;
            remaining[k] -= probability[k];
        }
        if (!(unfinished > 0)) return;
    }
}

/// Returns 32 random bits of one attempt at a Poisson number. `stream`: the random stream of the number; `attempt`:
/// index of the attempt; `half`: 0 for the bits of u, and 1 for those of v.
REALCAM_INLINE std::uint32_t attempt_bits(std::uint32_t stream, std::uint32_t attempt, std::uint32_t half) {
    return hash32(stream, 2 * attempt + half);
}

/// Samples a Poisson number with a finite mean of at least 10, by rejection. `stream`: the random stream of the number.
REALCAM_HD inline double poisson_by_rejection(double mean, std::uint32_t stream) {
    const PoissonHat hat(mean);
    for (std::uint32_t i = 0;; ++i) {
        const double u = open_unit_double(attempt_bits(stream, i, 0)), v = open_unit_double(attempt_bits(stream, i, 1));
        const PoissonAttempt attempt = hat.attempt(u, v);
        if (attempt.is_accepted || (attempt.is_possible && hat.is_accepted_slowly(attempt.count, u, v)))
            return attempt.count;
    }
}

}  // namespace REALCAM_NAMESPACE
