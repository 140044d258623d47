#pragma once
#include "lanes.hpp"

namespace REALCAM_NAMESPACE {

// Tables of count + 1 cumulative probabilities, from 0 to 1, in steps of 2^-24 (append_cdf): these are the steps of the
// random numbers, so that an entry is chosen exactly as often as its probability says.

/// First index whose cumulative probability exceeds u.
REALCAM_INLINE int find_in_cdf(const float* cdf, int count, float u) {
    int first = 0, last = count;
    while (first + 1 < last) {
        const int middle = (first + last) / 2;
        if (cdf[middle] <= u) {
            first = middle;
        } else {
            last = middle;
        }
    }
    return first;
}

/// An entry chosen from a table.
struct CdfChoice {
    int index;
    float probability;
    float fresh;  ///< a random number in (0, 1), made of what the choice left over
};

REALCAM_INLINE CdfChoice choose_from_cdf(const float* cdf, int count, float u) {
    const int index = find_in_cdf(cdf, count, u);
    const float probability = cdf[index + 1] - cdf[index];
    // From the middle of the random number's step: an entry of one step would give 0 for ever.
    const float fresh = (u - cdf[index] + 0x1p-25f) / probability;
    return {index, probability, select(fresh < 1.0f, fresh, 0x1.fffffep-1f)};
}

}  // namespace REALCAM_NAMESPACE
