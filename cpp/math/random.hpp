#pragma once
#include <cstdint>
#include <utility>

#include "lanes.hpp"

namespace REALCAM_NAMESPACE {

// Random numbers are functions of (seed, pixel, sample, dimension) and of nothing else: every backend, in whatever
// order it works, draws the same ones. Within a pixel the samples of a dimension pair are a (0,2)-sequence, so that
// the error of a picture falls faster than with independent numbers.

/// Bijective 32-bit hash with little bias.
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

/// Owen scrambling of a number in reversed bit order, as a hash in which each bit depends on the lower ones only (Laine
/// and Karras 2011; constants of Vegdahl 2021).
REALCAM_INLINE std::uint32_t scramble_reversed(std::uint32_t v, std::uint32_t seed) {
    v ^= v * 0x3d20adeau;
    v += seed;
    v *= (seed >> 16) | 1u;
    v ^= v * 0x05526c56u;
    v ^= v * 0x53a22864u;
    return v;
}

/// Converts 24 bits of a 32-bit fraction to a float in [0, 1). Through a signed integer: AVX2 cannot convert unsigned
/// ones.
REALCAM_INLINE float unit_float(std::uint32_t bits) {
    return static_cast<float>(static_cast<std::int32_t>(bits >> 8)) * 0x1p-24f;
}

/// Limits a random number that rounding may have raised to 1 to the largest float below 1.
REALCAM_INLINE float below_one(float u) {
    return select(u < 0x1.fffffep-1f, u, 0x1.fffffep-1f);
}

/// Reuses the remainder of a random number after a choice with this probability, which is above `u`: returns a random
/// number in [0, 1).
REALCAM_INLINE float left_over(float u, float probability) {
    return below_one(u / probability);
}

/// Second Sobol' dimension of an index, in reversed bit order: the generator matrix is Pascal's triangle modulo 2,
/// applied in five steps.
REALCAM_INLINE std::uint32_t sobol_second(std::uint32_t index) {
    std::uint32_t v = index;
    v ^= v >> 16;
    v ^= (v & 0xff00ff00u) >> 8;
    v ^= (v & 0xf0f0f0f0u) >> 4;
    v ^= (v & 0xccccccccu) >> 2;
    v ^= (v & 0xaaaaaaaau) >> 1;
    return v;
}

/// Returns a point of a shuffled, scrambled (0,2)-sequence in [0,1)^2 (Burley 2020). `stream` is a hash of seed and
/// pixel.
REALCAM_INLINE Vec2f sample_2d(std::uint32_t stream, std::uint32_t sample, std::uint32_t dimension) {
    const std::uint32_t seed = hash32(stream, dimension);
    // The shuffled index is the first Sobol' dimension in reversed bit order.
    const std::uint32_t index = reverse_bits(scramble_reversed(reverse_bits(sample), seed));
    const std::uint32_t x = reverse_bits(scramble_reversed(index, hash32(seed ^ 0x68bc21ebu)));
    const std::uint32_t y = reverse_bits(scramble_reversed(sobol_second(index), hash32(seed ^ 0x02e5be93u)));
    return {unit_float(x), unit_float(y)};
}

/// Number of dimension pairs that are sampled jointly. The first dimensions of a path are coupled: a film point and a
/// pupil point together determine where a ray hits the scene. Points of one sequence in all these dimensions have half
/// the error of independent pairs (benchmarks/samplers.cpp).
inline constexpr std::uint32_t kJointPairs = 5;

namespace random_detail {

/// Generator matrix of a Sobol' dimension after the first two, which are functions above; direction numbers by S. Joe
/// and F. Y. Kuo, "Constructing Sobol sequences with better two-dimensional projections" (SIAM Journal on Scientific
/// Computing 30, 2008). For each bit of the index, the bits of the number that it flips, in reversed bit order.
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

/// Matrices of the dimension pairs after the first.
inline constexpr SobolMatrix kSobol[kJointPairs - 1][2] = {
    {{2, 1, {1, 3}}, {3, 1, {1, 3, 1}}},
    {{3, 2, {1, 1, 1}}, {4, 1, {1, 1, 3, 3}}},
    {{4, 4, {1, 3, 5, 13}}, {5, 2, {1, 1, 5, 5, 17}}},
    {{5, 4, {1, 1, 5, 5, 5}}, {5, 7, {1, 1, 7, 11, 19}}},
};

/// Adds the matrix columns of these index bits to both numbers of a pair. They are constants in the code: a GPU cannot
/// look them up here.
template <std::uint32_t pair, int first, int... bits>
REALCAM_INLINE void add_columns(std::uint32_t index, std::uint32_t& x, std::uint32_t& y,
                                std::integer_sequence<int, bits...>) {
    const auto add = [&]<int bit>(std::integral_constant<int, bit>) {
        constexpr std::uint32_t of_x = kSobol[pair - 1][0].columns[bit], of_y = kSobol[pair - 1][1].columns[bit];
        const auto wanted = static_cast<std::uint32_t>(static_cast<std::int32_t>(index << (31 - bit)) >> 31);
        x ^= of_x & wanted;
        y ^= of_y & wanted;
    };
    (add(std::integral_constant<int, first + bits>{}), ...);
}

template <std::uint32_t pair, int bits>
REALCAM_INLINE void sobol_pair(std::uint32_t index, std::uint32_t& x, std::uint32_t& y) {
    add_columns<pair, 0>(index, x, y, std::make_integer_sequence<int, 8>{});
    if (bits > 8 || (bits == 0 && index >> 8 != 0))
        add_columns<pair, 8>(index, x, y, std::make_integer_sequence<int, 8>{});
    if (bits > 16 || (bits == 0 && index >> 16 != 0))
        add_columns<pair, 16>(index, x, y, std::make_integer_sequence<int, 16>{});
}

}  // namespace random_detail

/// Returns a pair of dimensions, less than kJointPairs, of a point of a scrambled Sobol' sequence in all of them. The
/// first pair is a (0,2)-sequence. `stream` is a hash of seed and pixel: Owen scrambling makes sequences of different
/// streams independent, so that their order need not be shuffled. `bits`: greatest number of bits of a sample index; 0:
/// determined from `sample`.
template <int bits = 0>
REALCAM_INLINE Vec2f sample_joint_2d(std::uint32_t stream, std::uint32_t sample, std::uint32_t pair) {
    using namespace random_detail;
    std::uint32_t x = 0, y = 0;  // in reversed bit order
    switch (pair) {
        case 0:
            x = sample;
            y = sobol_second(sample);
            break;
        case 1: sobol_pair<1, bits>(sample, x, y); break;
        case 2: sobol_pair<2, bits>(sample, x, y); break;
        case 3: sobol_pair<3, bits>(sample, x, y); break;
        default: sobol_pair<4, bits>(sample, x, y); break;
    }
    // A salt that no dimension of sample_2d uses. Hashed twice: seeds that were hashed once are correlated.
    const std::uint32_t seed = hash32(stream, ~pair);
    const std::uint32_t a = reverse_bits(scramble_reversed(x, hash32(seed ^ 0x68bc21ebu)));
    const std::uint32_t b = reverse_bits(scramble_reversed(y, hash32(seed ^ 0x02e5be93u)));
    return {unit_float(a), unit_float(b)};
}

/// Density of each point of sample_joint_2d by itself, over all streams.
REALCAM_INLINE float square_pdf(Vec2f u) {
    return ((u.x >= 0.0f) & (u.x < 1.0f) & (u.y >= 0.0f) & (u.y < 1.0f)) ? 1.0f : 0.0f;
}

}  // namespace REALCAM_NAMESPACE
