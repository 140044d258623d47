#pragma once
#include <bit>
#include <cmath>
#include <cstdint>

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

// Poisson sampling without an approximation of the distribution: by inversion for small means, and by transformed
// rejection for large ones (Hoermann 1993, "The transformed rejection method for generating Poisson random variables",
// algorithm PTRS). All in double: a mean of 1e7 electrons has a standard deviation of 3e3.

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
    double count;  ///< whole; the result if accepted
    bool is_accepted;  ///< without further tests: some 9 in 10
    bool is_possible;  ///< if not accepted: is_accepted_slowly decides
};

/// Hat function of PTRS for one mean of at least 10.
struct PoissonHat {
    double mean, b, a, least_v;

    REALCAM_INLINE explicit PoissonHat(double mean_)
        : mean(mean_),
          b(0.931 + 2.53 * std::sqrt(mean_)),
          a(-0.059 + 0.02483 * b),
          least_v(0.9277 - 3.6224 / (b - 2)) {}

    /// Makes an attempt from u and v in (0, 1).
    REALCAM_INLINE PoissonAttempt attempt(double u, double v) const {
        const double from_middle = u - 0.5, to_edge = 0.5 - std::fabs(from_middle);
        const double count = std::floor((2 * a / to_edge + b) * from_middle + mean + 0.43);
        const bool accepted = (to_edge >= 0.07) & (v <= least_v);
        const bool possible = (count >= 0) & ((to_edge >= 0.013) | (v <= to_edge));
        return {count, accepted, possible};
    }

    /// Decides on an attempt that is possible and not accepted at once.
    REALCAM_HD bool is_accepted_slowly(double count, double u, double v) const {
        const double to_edge = 0.5 - std::fabs(u - 0.5);
        const double inverse_alpha = 1.1239 + 1.1328 / (b - 3.4);
        return std::log(v * inverse_alpha / (a / (to_edge * to_edge) + b)) <=
               count * std::log(mean) - mean - log_factorial(count);
    }

    /// log(k!), to 1e-10 of its value: Stirling's series from 10 on, a product below.
    REALCAM_HD static double log_factorial(double k) {
        double shift = 1;
        for (; k < 10; ++k) shift *= k + 1;
        const double inverse = 1 / k, square = inverse * inverse;
        const double series = inverse * (1.0 / 12 - square * (1.0 / 360 - square * (1.0 / 1260 - square / 1680)));
        return (k + 0.5) * std::log(k) - k + 0.91893853320467274178 + series - std::log(shift);
    }
};

/// e^-x for x from 0 to 40, to 8e-15 of its value. Plain arithmetic, so that lane loops with it become vector code.
REALCAM_INLINE double exp_of_negative(double x) {
    constexpr double kLog2 = 0.693147180559945309417;
    const double halvings = std::floor(x / kLog2 + 0.5), r = halvings * kLog2 - x;  // -0.35 .. 0.35
    double sum = 1;
    REALCAM_UNROLL
    for (int k = 13; k >= 1; --k) sum = 1 + r * (1.0 / k) * sum;
    const auto exponent = static_cast<std::int64_t>(1023 - static_cast<std::int32_t>(halvings));
    return sum * std::bit_cast<double>(exponent << 52);
}

/// Samples Poisson numbers by inversion, for means up to kLargestInvertedMean: counts the partial sums of the
/// probabilities that are below u, a uniform number in (0, 1) of 53 bits. All lanes iterate until the last one is done,
/// which is quicker than one by one: a step has no division and no divergent branch. Counts for larger means are
/// undefined.
template <int N>
REALCAM_HD void invert_poisson(const double (&mean)[N], const double (&u)[N], double (&count)[N]) {
    constexpr int kFarthest = 160;  // a probability of 1e-40 at the largest mean
    alignas(64) double probability[N], left[N];  // left: u less the sum so far
    REALCAM_LANES
    for (int k = 0; k < N; ++k) {
        const double m = mean[k] < kLargestInvertedMean ? mean[k] : 0.0;
        probability[k] = exp_of_negative(m);
        left[k] = m > 0.0 ? u[k] - probability[k] : 0.0;
        count[k] = 0;
    }
    for (int step = 1; step < kFarthest; ++step) {
        const double inverse = 1.0 / step;
        double going = 0;
        REALCAM_LANES
        for (int k = 0; k < N; ++k) {
            const double one = left[k] > 0.0 ? 1.0 : 0.0;
            count[k] += one;
            going += one;
            probability[k] *= mean[k] * inverse;
            left[k] -= probability[k];
        }
        if (!(going > 0)) return;
    }
}

/// Returns the random bits of one attempt at a Poisson number, by its stream and the attempt; `half` is 0 or 1.
REALCAM_INLINE std::uint32_t attempt_bits(std::uint32_t stream, std::uint32_t attempt, std::uint32_t half) {
    return hash32(stream, 2 * attempt + half);
}

/// Samples a Poisson number with a finite mean of at least 10, by rejection. Attempts before `first_attempt` have
/// failed.
REALCAM_HD inline double poisson_by_rejection(double mean, std::uint32_t stream, std::uint32_t first_attempt = 0) {
    const PoissonHat hat(mean);
    for (std::uint32_t i = first_attempt;; ++i) {
        const double u = open_unit_double(attempt_bits(stream, i, 0)), v = open_unit_double(attempt_bits(stream, i, 1));
        const PoissonAttempt attempt = hat.attempt(u, v);
        if (attempt.is_accepted || (attempt.is_possible && hat.is_accepted_slowly(attempt.count, u, v)))
            return attempt.count;
    }
}

}  // namespace REALCAM_NAMESPACE
