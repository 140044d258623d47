#pragma once
#include <algorithm>
#include <vector>

#include "../camera/pixel_pupil.hpp"
#include "../math/random.hpp"
#include "sample_range.hpp"

namespace REALCAM_NAMESPACE {

/// The passes of a range, after each of which pixels learn. What a sample knows must not depend on how samples are
/// spread over threads, and hangs together with its number alone. Each pass has random numbers of its own: samples of
/// one sequence keep away from each other, and what was learnt from the first of them would tell where the later ones
/// are not.
inline std::vector<SampleRange> learning_passes(const SampleRange& range) {
    std::vector<SampleRange> passes;
    const std::uint64_t last = std::uint64_t{range.first} + range.count;
    std::uint64_t first = range.first, end = pixel_pupil::kFirstPass;
    std::uint32_t number = 0;
    while (first < last) {
        for (; end <= first; end *= 2) ++number;
        const std::uint64_t count = std::min(end, last) - first;
        passes.push_back(
            {hash32(range.seed, number), static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count)});
        first += count;
    }
    return passes;
}

}  // namespace REALCAM_NAMESPACE
