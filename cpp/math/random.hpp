#pragma once
#include <cstdint>
#include <utility>

#include "vec3.hpp"

namespace REALCAM_NAMESPACE {

// Random numbers are functions of (seed, pixel, sample, dimension) and of nothing else: every backend, in whatever
// order it works, draws the same ones. Within a pixel the samples of a dimension pair are a (0,2)-sequence, so that
// the error of a picture falls faster than with independent numbers.

/// A bijective mix of 32 bits with little bias.
REALCAM_INLINE std::uint32_t hash32(std::uint32_t v) {
    v ^= v >> 16;
    v *= 0x7feb352du;
    v ^= v >> 15;
    v *= 0x846ca68bu;
    v ^= v >> 16;
    return v;
}

REALCAM_INLINE std::uint32_t hash32(std::uint32_t a, std::uint32_t b) {
    return hash32(a ^ hash32(b + 0x9e3779b9u));
}

/// Owen's scrambling of a number whose bits stand in reverse order, as a hash in which each bit depends on the lower
/// ones only (Laine and Karras 2011; constants of Vegdahl 2021).
REALCAM_INLINE std::uint32_t scramble_reversed(std::uint32_t v, std::uint32_t seed) {
    v ^= v * 0x3d20adeau;
    v += seed;
    v *= (seed >> 16) | 1u;
    v ^= v * 0x05526c56u;
    v ^= v * 0x53a22864u;
    return v;
}

/// 24 bits of a 32-bit fraction as a float in [0, 1). Through a signed integer: AVX2 cannot convert unsigned ones.
REALCAM_INLINE float unit_float(std::uint32_t bits) {
    return static_cast<float>(static_cast<std::int32_t>(bits >> 8)) * 0x1p-24f;
}

/// Second Sobol' dimension of an index given with its bits in reverse order: the generator matrix is Pascal's
/// triangle modulo 2, applied in five steps.
REALCAM_INLINE std::uint32_t sobol_second(std::uint32_t reversed_index) {
    std::uint32_t v = reversed_index;
    v ^= v << 16;
    v ^= (v & 0x00ff00ffu) << 8;
    v ^= (v & 0x0f0f0f0fu) << 4;
    v ^= (v & 0x33333333u) << 2;
    v ^= (v & 0x55555555u) << 1;
    return v;
}

/// A point of a shuffled, scrambled (0,2)-sequence in [0,1)^2 (Burley 2020). `stream` stands for seed and pixel.
REALCAM_INLINE Vec2f sample_2d(std::uint32_t stream, std::uint32_t sample, std::uint32_t dimension) {
    const std::uint32_t seed = hash32(stream, dimension);
    // The shuffled index, bits reversed: the first Sobol' dimension itself.
    const std::uint32_t first = scramble_reversed(reverse_bits(sample), seed);
    const std::uint32_t second = sobol_second(first);
    const std::uint32_t x = reverse_bits(scramble_reversed(reverse_bits(first), hash32(seed ^ 0x68bc21ebu)));
    const std::uint32_t y = reverse_bits(scramble_reversed(reverse_bits(second), hash32(seed ^ 0x02e5be93u)));
    return {unit_float(x), unit_float(y)};
}

/// The first dimensions of a path hang together: light of a film point falls where the pupil's point sends it. Their
/// samples are one sequence in all of them, which errs half as much as pairs that know nothing of each other
/// (benchmarks/samplers.cpp).
inline constexpr std::uint32_t kJointPairs = 5;

namespace random_detail {

inline constexpr int kQuickBits = 16;  ///< of an index, that most pictures' samples have

/// Sobol' dimensions, of which the first two are functions, by S. Joe and F. Y. Kuo, "Constructing Sobol sequences with
/// better two-dimensional projections" (SIAM Journal on Scientific Computing 30, 2008). Of each bit of the index, the
/// bits of the number that it turns, these in reverse order.
struct SobolMatrix {
    std::uint32_t columns[32];

    constexpr SobolMatrix(int degree, std::uint32_t coefficients, const std::uint32_t (&first)[5]) : columns{} {
        std::uint32_t m[32] = {};
        for (int i = 0; i < 32; ++i) {
            m[i] = i < degree ? first[i] : m[i - degree] ^ m[i - degree] << degree;
            for (int k = 1; k < degree && i >= degree; ++k)
                if (coefficients >> (degree - 1 - k) & 1u) m[i] ^= m[i - k] << k;
            for (int bit = 0; bit <= i; ++bit) columns[i] |= (m[i] >> bit & 1u) << (i - bit);
        }
    }
};

/// The matrices of the pairs after the first.
inline constexpr SobolMatrix kSobol[kJointPairs - 1][2] = {
    {{2, 1, {1, 3}}, {3, 1, {1, 3, 1}}},
    {{3, 2, {1, 1, 1}}, {4, 1, {1, 1, 3, 3}}},
    {{4, 4, {1, 3, 5, 13}}, {5, 2, {1, 1, 5, 5, 17}}},
    {{5, 4, {1, 1, 5, 5, 5}}, {5, 7, {1, 1, 7, 11, 19}}},
};

/// Adds the columns of `bits` to both numbers of a pair. As constants in the code: a GPU cannot look them up here.
template <std::uint32_t pair, int first, int... bits>
REALCAM_INLINE void add_columns(std::uint32_t index, std::uint32_t& x, std::uint32_t& y,
                                std::integer_sequence<int, bits...>) {
    const auto add = [&]<int bit>(std::integral_constant<int, bit>) {
        constexpr std::uint32_t of_x = kSobol[pair - 1][0].columns[bit], of_y = kSobol[pair - 1][1].columns[bit];
        const std::uint32_t wanted = 0u - (index >> bit & 1u);
        x ^= of_x & wanted;
        y ^= of_y & wanted;
    };
    (add(std::integral_constant<int, first + bits>{}), ...);
}

template <std::uint32_t pair>
REALCAM_INLINE void sobol_pair(std::uint32_t index, std::uint32_t& x, std::uint32_t& y) {
    x = y = 0;
    add_columns<pair, 0>(index, x, y, std::make_integer_sequence<int, kQuickBits>{});
    if (index >> kQuickBits != 0)
        add_columns<pair, kQuickBits>(index, x, y, std::make_integer_sequence<int, 32 - kQuickBits>{});
}

}  // namespace random_detail

/// A pair of dimensions, less than kJointPairs, of a point of a shuffled, scrambled Sobol' sequence in all of them. The
/// first pair is a (0,2)-sequence. `stream` stands for seed and pixel.
REALCAM_INLINE Vec2f sample_joint_2d(std::uint32_t stream, std::uint32_t sample, std::uint32_t pair) {
    using namespace random_detail;
    const std::uint32_t seed = hash32(stream, pair);
    // Shuffled within blocks that one loop's bits can count.
    const std::uint32_t reversed = scramble_reversed(reverse_bits(sample), hash32(stream));
    const std::uint32_t index =
        (reverse_bits(reversed) & ((1u << kQuickBits) - 1u)) | (sample >> kQuickBits << kQuickBits);
    std::uint32_t x = reverse_bits(index), y = 0;  // each in reverse order
    switch (pair) {
        case 0:
            y = reverse_bits(sobol_second(x));
            x = index;
            break;
        case 1: sobol_pair<1>(index, x, y); break;
        case 2: sobol_pair<2>(index, x, y); break;
        case 3: sobol_pair<3>(index, x, y); break;
        default: sobol_pair<4>(index, x, y); break;
    }
    const std::uint32_t a = reverse_bits(scramble_reversed(x, hash32(seed ^ 0x68bc21ebu)));
    const std::uint32_t b = reverse_bits(scramble_reversed(y, hash32(seed ^ 0x02e5be93u)));
    return {unit_float(a), unit_float(b)};
}

/// Density of each of its points by itself, over all streams.
REALCAM_INLINE float square_pdf(Vec2f u) {
    return ((u.x >= 0.0f) & (u.x < 1.0f) & (u.y >= 0.0f) & (u.y < 1.0f)) ? 1.0f : 0.0f;
}

}  // namespace REALCAM_NAMESPACE
