#pragma once
#include <cstdint>

namespace realcam {

/// Returns the number of threads that share the samples of a pixel: a power of two up to 32, at most one per sample.
inline int lanes_per_pixel(std::int64_t pixels, std::int64_t samples) {
    constexpr int kMost = 32;  // warp size
    /// kAtOnce exceeds the number of threads that a large GPU runs at once. With kEnough threads in a launch the tail,
    /// which leaves the GPU half empty, is negligible.
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
