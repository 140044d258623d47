#include "learning_passes.hpp"

#include <algorithm>

namespace realcam {

std::vector<SampleRange> learning_passes(const SampleRange& range) {
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

}  // namespace realcam
