// How a launch on a GPU shares out the samples of a pixel. The threads of a warp run in step: one that has a sample
// less than its neighbour waits.

#include <algorithm>
#include <cstdint>

#include "cuda/kernels/lanes_per_pixel.hpp"
#include "doctest/doctest.h"

using namespace realcam;

namespace {

/// Share of the threads' steps in which they have a sample.
double share_used(std::int64_t samples, int lanes) {
    const std::int64_t rounds = (samples + lanes - 1) / lanes;
    return static_cast<double>(samples) / static_cast<double>(rounds * lanes);
}

}  // namespace

TEST_CASE("a live frame of 640 x 640 pixels leaves no thread idle for long, whatever its samples") {
    for (std::int64_t samples = 1; samples <= 64; ++samples) {
        CAPTURE(samples);
        // At worst 7 samples on 4 threads, or 21 on 8: more threads are worth an eighth of their steps where they leave
        // less of the GPU empty at the end.
        CHECK(share_used(samples, lanes_per_pixel(640 * 640, samples)) >= 0.875);
    }
    CHECK(lanes_per_pixel(640 * 640, 20) ==
          4);  // 5 rounds of 4; 16 threads would take two rounds, the second one for 4
}

TEST_CASE("few pixels are shared by as many threads as have samples, up to a warp") {
    for (const std::int64_t pixels : {1, 100, 1000}) {
        CHECK(lanes_per_pixel(pixels, 1) == 1);
        CHECK(lanes_per_pixel(pixels, 3) == 2);
        CHECK(lanes_per_pixel(pixels, 16) == 16);
        CHECK(lanes_per_pixel(pixels, 1 << 24) == 32);
    }
}

TEST_CASE("a film of many pixels needs no second thread for any") {
    CHECK(lanes_per_pixel(32768ll * 32768, 1 << 24) == 1);
}

TEST_CASE("a launch on no pixels, and one without samples, have a thread") {
    CHECK(lanes_per_pixel(0, 0) == 1);
    CHECK(lanes_per_pixel(0, 16) >= 1);
}
