#pragma once
#include "../camera/lane_numbers.hpp"
#include "path_state.hpp"

namespace REALCAM_NAMESPACE {

/// Random numbers of one dimension of a bounce, for each path. A GPU's thread draws them on demand, because it has no
/// registers to keep them.
template <int N>
class PathNumbers {
public:
    REALCAM_INLINE PathNumbers(const SampleBlock<N>& block, const PathState<N>& path, std::uint32_t dimension)
        : numbers_(block, dimension, whole_vectors<N>(path.count), [&](int slot) { return path.lane(slot); }) {}

    REALCAM_INLINE Vec2f operator[](int slot) const { return numbers_[slot]; }

private:
    LaneNumbers<N> numbers_;
};

template <>
class PathNumbers<1> {
public:
    REALCAM_INLINE PathNumbers(const SampleBlock<1>& block, const PathState<1>&, std::uint32_t dimension)
        : block_(block), dimension_(dimension) {}

    REALCAM_INLINE Vec2f operator[](int) const {
        // By named constants, so that no code is generated for the other dimensions of the joint sequence.
        if (dimension_ == kFirstLight) return block_.random(0, kFirstLight);
        if (dimension_ == kFirstScatter) return block_.random(0, kFirstScatter);
        return sample_2d(block_.stream[0], block_.sample[0], dimension_);
    }

private:
    static constexpr std::uint32_t kFirstLight = dimension::first_bounce + dimension::light,
                                   kFirstScatter = dimension::first_bounce + dimension::scatter;

    const SampleBlock<1>& block_;
    std::uint32_t dimension_;
};

}  // namespace REALCAM_NAMESPACE
