#pragma once
#include <cstdint>

namespace realcam {

/// Threads of a launch that share the samples of a pixel: 1, 2, 4 ... 32 of them, none without a sample.
inline int lanes_per_pixel(std::int64_t pixels, std::int64_t samples) {
    constexpr int kMost = 32;  // a warp
    /// More threads than a large GPU runs at once; and so many that the last ones, which leave it half empty, count for
    /// little.
    constexpr std::int64_t kAtOnce = 1 << 17, kEnough = 1 << 22;
    int best = 1;
    std::int64_t least = 0;
    for (int lanes = 1; lanes <= kMost && lanes <= samples; lanes *= 2) {
        // A warp takes as long as its thread with the most samples: 20 samples on 16 threads are as slow as 32.
        const std::int64_t rounds = (samples + lanes - 1) / lanes, cost = rounds * (pixels * lanes + kAtOnce);
        if (lanes == 1 || cost <= least) {
            best = lanes;
            least = cost;
        }
        if (pixels * lanes >= kEnough) break;
    }
    return best;
}

}  // namespace realcam
