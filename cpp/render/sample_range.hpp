#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Samples of every pixel, as the random numbers know them.
struct SampleRange {
    std::uint32_t seed, first, count;
};

/// A picture on a CPU adds its samples up in pieces of so many, beginning with the first, so that parts of this size
/// that are exposed apart give the same sums.
inline constexpr std::uint32_t kSamplesPerSum = 256;

/// How many samples of a range single pixels take: the first ones, up to their number.
struct PixelCounts {
    const std::uint32_t* counts = nullptr;  ///< of the film's pixels, row by row; none: all samples
    std::uint32_t taken = 0;                ///< of them, before the range

    /// The counts of the rest of the range, behind so many of its samples.
    PixelCounts behind(std::uint32_t samples) const { return {counts, taken + samples}; }

    std::uint32_t of(std::size_t pixel, const SampleRange& range) const {
        if (!counts) return range.count;
        return std::min(counts[pixel] > taken ? counts[pixel] - taken : 0, range.count);
    }
};

/// The next samples from `taken` to `wanted`, or those up to where a random sequence ends. A sequence has 2^32 samples,
/// and a picture that is never finished continues with the sequence of the next seed.
inline SampleRange next_samples(std::uint32_t seed, std::int64_t taken, std::int64_t wanted) {
    constexpr std::int64_t kSequence = std::int64_t{1} << 32;
    const std::int64_t first = taken % kSequence, count = std::min(wanted - taken, kSequence - first);
    return {seed + static_cast<std::uint32_t>(taken / kSequence), static_cast<std::uint32_t>(first),
            static_cast<std::uint32_t>(count)};
}

}  // namespace REALCAM_NAMESPACE
