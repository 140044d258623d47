#pragma once
#include <cstdint>
#include <utility>

#include "lanes.hpp"

namespace REALCAM_NAMESPACE {

// Quasi-random numbers: Owen-scrambled Sobol' sequences. A number is a function of seed, pixel, sample, and dimension
// alone, so that all backends draw the same numbers in any order of execution. Within a pixel the samples of a pair of
// dimensions form a (0,2)-sequence, with which the error of a picture decreases faster than with independent numbers.

/// Bijective 32-bit hash with little bias (C. Wellons, "Prospecting for Hash Functions", 2018: lowbias32).
REALCAM_INLINE std::uint32_t hash32(std::uint32_t v) {
    v ^= v >> 16;
    v *= 0x7feb352du;
    v ^= v >> 15;
    v *= 0x846ca68bu;
    v ^= v >> 16;
    return v;
}

/// Hash of two numbers.
REALCAM_INLINE std::uint32_t hash32(std::uint32_t a, std::uint32_t b) {
    return hash32(a ^ hash32(b + 0x9e3779b9u));
}

/// Owen scrambling of a number in reversed bit order, by a hash in which each bit depends only on lower bits (Laine and
/// Karras 2011; constants by Vegdahl 2021).
REALCAM_INLINE std::uint32_t scramble_reversed(std::uint32_t v, std::uint32_t seed) {
    v ^= v * 0x3d20adeau;
    v += seed;
    v *= (seed >> 16) | 1u;
    v ^= v * 0x05526c56u;
    v ^= v * 0x53a22864u;
    return v;
}

/// Converts the upper 24 bits of a 32-bit fraction to a float in [0, 1), a multiple of 2^-24. It converts a signed
/// integer, because AVX2 cannot convert unsigned integers.
REALCAM_INLINE float unit_float(std::uint32_t bits) {
    return static_cast<float>(static_cast<std::int32_t>(bits >> 8)) * 0x1p-24f;
}

/// Returns the random number u, or the largest float below 1 if rounding has raised u to 1.
REALCAM_INLINE float below_one(float u) {
    return select(u < 0x1.fffffep-1f, u, 0x1.fffffep-1f);
}

/// Remaps a random number that has been used for a choice: u, which must be less than the probability of the outcome,
/// is scaled to a new random number in [0, 1), independent of the choice.
REALCAM_INLINE float remapped_random(float u, float probability) {
    return below_one(u / probability);
}

/// Returns the second dimension of a point of the Sobol' sequence in reversed bit order, by its index. The generator
/// matrix, Pascal's triangle modulo 2, is applied in five steps.
REALCAM_INLINE std::uint32_t sobol_second(std::uint32_t index) {
    std::uint32_t v = index;
    v ^= v >> 16;
    v ^= (v & 0xff00ff00u) >> 8;
    v ^= (v & 0xf0f0f0f0u) >> 4;
    v ^= (v & 0xccccccccu) >> 2;
    v ^= (v & 0xaaaaaaaau) >> 1;
    return v;
}

/// Arbitrary numbers that make the scrambling seeds of the two dimensions of a pair differ.
inline constexpr std::uint32_t kSaltX = 0x68bc21ebu, kSaltY = 0x02e5be93u;

/// Returns point `sample` of a shuffled and scrambled (0,2)-sequence in [0, 1)^2 (Burley 2020). `stream`: hash of seed
/// and pixel. `dimension`: index of the pair of dimensions; different pairs are independent.
REALCAM_INLINE Vec2f sample_2d(std::uint32_t stream, std::uint32_t sample, std::uint32_t dimension) {
    const std::uint32_t seed = hash32(stream, dimension);
    // The shuffled index, in reversed bit order, is the first Sobol' dimension.
    const std::uint32_t index = reverse_bits(scramble_reversed(reverse_bits(sample), seed));
    const std::uint32_t x = reverse_bits(scramble_reversed(index, hash32(seed ^ kSaltX)));
    const std::uint32_t y = reverse_bits(scramble_reversed(sobol_second(index), hash32(seed ^ kSaltY)));
    return {unit_float(x), unit_float(y)};
}

/// Number of pairs of dimensions that sample_joint_2d samples jointly. The first dimensions of a path are coupled: film
/// point and pupil point together determine where a ray hits the scene. One Sobol' sequence in all of them has half the
/// error of independent pairs (benchmarks/samplers.cpp).
inline constexpr std::uint32_t kJointPairs = 5;

namespace random_detail {

/// Generator matrix of a Sobol' dimension after the second, from direction numbers by S. Joe and F. Y. Kuo,
/// "Constructing Sobol sequences with better two-dimensional projections" (SIAM Journal on Scientific Computing 30,
/// 2008).
struct SobolMatrix {
    std::uint32_t columns[32];  ///< for each bit of the index: bits that it flips, in reversed bit order

    /// `degree`, `coefficients`: primitive polynomial, s and a of Joe and Kuo; `first`: its initial direction numbers.

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

/// Matrices of the pairs of dimensions after the first pair.
inline constexpr SobolMatrix kSobol[kJointPairs - 1][2] = {
    {{2, 1, {1, 3}}, {3, 1, {1, 3, 1}}},
    {{3, 2, {1, 1, 1}}, {4, 1, {1, 1, 3, 3}}},
    {{4, 4, {1, 3, 5, 13}}, {5, 2, {1, 1, 5, 5, 17}}},
    {{5, 4, {1, 1, 5, 5, 5}}, {5, 7, {1, 1, 7, 11, 19}}},
};

/// Adds (modulo 2) the matrix columns of index bits `first` + `bits` to both numbers of a pair. The columns are
/// constants in the code, because device code cannot read a host array.
template <std::uint32_t pair, int first, int... bits>
REALCAM_INLINE void add_columns(std::uint32_t index, std::uint32_t& x, std::uint32_t& y,
                                std::integer_sequence<int, bits...>) {
    const auto add = [&]<int bit>(std::integral_constant<int, bit>) {
        constexpr std::uint32_t column_x = kSobol[pair - 1][0].columns[bit],
                                column_y = kSobol[pair - 1][1].columns[bit];
        // All ones if the index bit is set, otherwise 0.
        const auto mask = static_cast<std::uint32_t>(static_cast<std::int32_t>(index << (31 - bit)) >> 31);
        x ^= column_x & mask;
        y ^= column_y & mask;
    };
    (add(std::integral_constant<int, first + bits>{}), ...);
}

/// Adds the two dimensions of a pair to x and y, which must be 0. `bits`: see sample_joint_2d.
template <std::uint32_t pair, int bits>
REALCAM_INLINE void sobol_pair(std::uint32_t index, std::uint32_t& x, std::uint32_t& y) {
    add_columns<pair, 0>(index, x, y, std::make_integer_sequence<int, 8>{});
    if (bits > 8 || (bits == 0 && index >> 8 != 0))
        add_columns<pair, 8>(index, x, y, std::make_integer_sequence<int, 8>{});
    if (bits > 16 || (bits == 0 && index >> 16 != 0))
        add_columns<pair, 16>(index, x, y, std::make_integer_sequence<int, 16>{});
}

}  // namespace random_detail

/// Returns one pair of dimensions (0 to kJointPairs - 1) of point `sample` of a scrambled Sobol' sequence with
/// kJointPairs pairs. The first pair is a (0,2)-sequence. `stream`: hash of seed and pixel. Owen scrambling makes the
/// sequences of different streams independent, so that their order need not be shuffled. `bits`: largest number of bits
/// of a sample index, if it is known at compile time; 0: it is determined from `sample`.
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
    // ~pair is a salt that no dimension of sample_2d uses. Seeds are hashed twice, because seeds that were hashed once
    // are correlated.
    const std::uint32_t seed = hash32(stream, ~pair);
    const std::uint32_t a = reverse_bits(scramble_reversed(x, hash32(seed ^ kSaltX)));
    const std::uint32_t b = reverse_bits(scramble_reversed(y, hash32(seed ^ kSaltY)));
    return {unit_float(a), unit_float(b)};
}

/// Density of a point of sample_joint_2d over all streams: 1 inside the unit square [0, 1)^2, and 0 outside.
REALCAM_INLINE float square_pdf(Vec2f u) {
    return ((u.x >= 0.0f) & (u.x < 1.0f) & (u.y >= 0.0f) & (u.y < 1.0f)) ? 1.0f : 0.0f;
}

}  // namespace REALCAM_NAMESPACE
