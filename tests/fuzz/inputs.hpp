#pragma once
// Inputs for fuzz targets where the compiler has no libFuzzer: bytes that are a function of a seed and a number.

#include <time.h>

#include <algorithm>
#include <vector>

#include "math/random.hpp"
#include "target.hpp"

namespace realcam::fuzz {

using Input = std::vector<std::uint8_t>;

inline Input input_of(std::uint32_t seed, std::uint64_t number) {
    const std::uint32_t key =
        hash32(hash32(static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(number >> 32)), seed);
    Input bytes(8 + key % 250);
    for (std::size_t i = 0; i < bytes.size(); ++i)
        bytes[i] = static_cast<std::uint8_t>(hash32(static_cast<std::uint32_t>(i), key) >> 24);
    return bytes;
}

inline double cpu_seconds() {
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Run {
    std::uint64_t inputs = 0;
    double seconds = 0, slowest = 0;  ///< processor time of all inputs, and of the slowest one
    Input first_broken;
};

/// Calls the target until `enough()`. `before` receives each input first, so that an input that hangs is known.
template <class Enough, class Before>
Run run_inputs(Target target, std::uint32_t seed, Enough&& enough, Before&& before) {
    Run run;
    const double start = cpu_seconds();
    double now = start;
    while (!enough()) {
        const Input bytes = input_of(seed, run.inputs);
        const std::uint64_t broken = findings().broken;
        findings().input = run.inputs++;
        before(bytes);
        target(bytes.data(), bytes.size());
        if (findings().broken != broken && run.first_broken.empty()) run.first_broken = bytes;
        const double end = cpu_seconds();
        run.slowest = std::max(run.slowest, end - now);
        now = end;
    }
    run.seconds = now - start;
    return run;
}

}  // namespace realcam::fuzz
