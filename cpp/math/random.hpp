#pragma once
#include <cstdint>

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

/// Density of each of its points by itself, over all streams.
REALCAM_INLINE float square_pdf(Vec2f u) {
    return (u.x >= 0.0f) & (u.x < 1.0f) & (u.y >= 0.0f) & (u.y < 1.0f) ? 1.0f : 0.0f;
}

}  // namespace REALCAM_NAMESPACE
