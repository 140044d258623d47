#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "../../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Samples of every pixel, by their indices in a random sequence.
struct SampleRange {
    std::uint32_t seed, first, count;
};

/// Number of samples that a picture on a CPU adds up at a time, beginning with the first. Parts of this size that are
/// exposed apart therefore give the same sums.
inline constexpr std::uint32_t kSamplesPerSum = 256;

/// Number of samples of a range that each pixel takes: the first ones, up to its count.
struct PixelCounts {
    const std::uint32_t* counts = nullptr;  ///< one for each pixel of the film, row by row; null: all samples
    std::uint32_t taken = 0;                ///< samples of these counts that were taken before the range

    /// Counts for the remainder of the range, after its first `samples` samples.
    PixelCounts behind(std::uint32_t samples) const { return {counts, taken + samples}; }

    std::uint32_t of(std::size_t pixel, const SampleRange& range) const {
        if (!counts) return range.count;
        return std::min(counts[pixel] > taken ? counts[pixel] - taken : 0, range.count);
    }
};

/// The next samples from `taken` to `wanted`, or up to the end of a random sequence. A sequence has 2^32 samples, and a
/// picture that is never finished continues with the sequence of the next seed.
inline SampleRange next_samples(std::uint32_t seed, std::int64_t taken, std::int64_t wanted) {
    constexpr std::int64_t kSequence = std::int64_t{1} << 32;
    const std::int64_t first = taken % kSequence, count = std::min(wanted - taken, kSequence - first);
    return {seed + static_cast<std::uint32_t>(taken / kSequence), static_cast<std::uint32_t>(first),
            static_cast<std::uint32_t>(count)};
}

}  // namespace REALCAM_NAMESPACE
