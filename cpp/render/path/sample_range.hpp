#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "../../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Consecutive samples of every pixel: those with the indices [first, first + count) in the low-discrepancy sequence of
/// a seed.
struct SampleRange {
    std::uint32_t seed, first, count;
};

/// Number of consecutive samples of a pixel that the CPU backend sums before it adds the sum to the film. Parts of a
/// picture that are rendered separately, in multiples of this size, therefore give bit-identical sums.
inline constexpr std::uint32_t kSamplesPerSum = 256;

/// Sample counts of individual pixels, for adaptive sampling: how many samples of a range, from its first one on, each
/// pixel takes.
struct PixelCounts {
    const std::uint32_t* counts = nullptr;  ///< per pixel of the film or region, row by row; null: all samples
    std::uint32_t taken = 0;  ///< number of samples before the range that `counts` includes

    /// Returns the counts for the part of the range that follows its first `samples` samples.
    PixelCounts after(std::uint32_t samples) const { return {counts, taken + samples}; }

    /// Returns the number of samples of the range that a pixel takes. `pixel`: index in `counts`.
    std::uint32_t of(std::size_t pixel, const SampleRange& range) const {
        if (!counts) return range.count;
        return std::min(counts[pixel] > taken ? counts[pixel] - taken : 0, range.count);
    }
};

/// Returns the samples with the indices [taken, end), or as many of them as the same sequence contains. A sequence has
/// 2^32 samples; an endless rendering continues with the sequence of the next seed. `seed`: that of index 0.
inline SampleRange next_samples(std::uint32_t seed, std::int64_t taken, std::int64_t end) {
    constexpr std::int64_t kSequenceLength = std::int64_t{1} << 32;
    const std::int64_t first = taken % kSequenceLength, count = std::min(end - taken, kSequenceLength - first);
    return {seed + static_cast<std::uint32_t>(taken / kSequenceLength), static_cast<std::uint32_t>(first),
            static_cast<std::uint32_t>(count)};
}

}  // namespace REALCAM_NAMESPACE
