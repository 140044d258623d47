#pragma once
#include <cstdint>

namespace realcam {

/// Returns the number of threads that share the samples of a pixel in a launch: a power of two up to 32, at most one
/// per sample. `pixels`: number of pixels; `samples`: samples per pixel.
inline int lanes_per_pixel(std::int64_t pixels, std::int64_t samples) {
    constexpr int kMaxLanes = 32;  // warp size
    // More than the number of threads that a large GPU runs at once: the cost of the end of a launch, in threads.
    constexpr std::int64_t kConcurrentThreads = 1 << 17;
    // With this number of threads, the end of a launch, which leaves the GPU partly idle, takes a negligible part of
    // its time.
    constexpr std::int64_t kEnoughThreads = 1 << 22;
    int best = 1;
    std::int64_t least_cost = 0;
    for (int lanes = 1; lanes <= kMaxLanes && lanes <= samples; lanes *= 2) {
        // The time of a launch in samples per thread. A warp takes as long as its thread with the most samples: 20
        // samples on 16 threads are as slow as 32.
        const std::int64_t rounds = (samples + lanes - 1) / lanes,
                           cost = rounds * (pixels * lanes + kConcurrentThreads);
        if (lanes == 1 || cost <= least_cost) {
            best = lanes;
            least_cost = cost;
        }
        if (pixels * lanes >= kEnoughThreads) break;
    }
    return best;
}

}  // namespace realcam
