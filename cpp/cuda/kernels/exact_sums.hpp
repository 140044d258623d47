#pragma once
#include "../../math/color.hpp"

namespace realcam {

/// Adds a contribution, rounded to a multiple of 2^-24, to a sum that several threads may add to, in any order. Doubles
/// hold up to 2^53 of these units exactly, so that the sum is independent of the order. `dither`: random number from 0
/// to 1, which makes the rounding unbiased.
__device__ inline void add_exact(double& sum, double value, float dither) {
    atomicAdd(&sum, 0x1p-24 * floor(0x1p24 * value + static_cast<double>(dither)));
}
__device__ inline void add_exact(double (&sums)[3], Color c, float dither) {
    add_exact(sums[0], static_cast<double>(c.r), dither);
    add_exact(sums[1], static_cast<double>(c.g), dither);
    add_exact(sums[2], static_cast<double>(c.b), dither);
}

}  // namespace realcam
