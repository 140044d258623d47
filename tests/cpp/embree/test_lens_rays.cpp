// Floating-point mode of the threads that trace a lens's rays.
#include "embree/lens_rays.hpp"

#include <doctest/doctest.h>
#include <immintrin.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <thread>
#include <vector>

using namespace realcam;

TEST_CASE("denormal numbers are none the less numbers where another library takes them for zeros") {
    constexpr double kSmallest = std::numeric_limits<double>::min();
    std::vector<double> numbers(1 << 16, kSmallest);
    // A thread of its own has no arena yet; TBB's threads get the rounding of whoever begins it.
    std::thread([&] {
        const unsigned mode = _mm_getcsr();
        _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
        tbb::parallel_for(0, 64, [](int) {});
        _mm_setcsr(mode);
        parallel_ray_loop({}, 64).for_all(numbers.size(), [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) numbers[i] /= 2;
        });
    }).join();
    CHECK(std::count(numbers.begin(), numbers.end(), kSmallest / 2) == std::ssize(numbers));
}
