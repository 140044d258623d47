#pragma once
#include "path_state.hpp"

namespace REALCAM_NAMESPACE {

/// The numbers of a dimension for each path: for many all at once, which is vector code. A GPU's thread draws them when
/// it wants them, because it has no registers in which to keep them.
template <int N>
class PathNumbers {
public:
    REALCAM_INLINE PathNumbers(const SampleBlock<N>& block, const PathState<N>& path, std::uint32_t dimension)
        : block_(block), dimension_(dimension) {
        if constexpr (N > 1) {
            if (dimension == kFirstLight)
                keep(path, [&](int lane) { return block.random(lane, kFirstLight); });
            else if (dimension == kFirstScatter)
                keep(path, [&](int lane) { return block.random(lane, kFirstScatter); });
            else
                keep(path, [&](int lane) { return sample_2d(block.stream[lane], block.sample[lane], dimension); });
        }
    }
    REALCAM_INLINE Vec2f operator[](int place) const {
        if constexpr (N > 1) return kept_[place];
        if (dimension_ == kFirstLight) return block_.random(0, kFirstLight);
        if (dimension_ == kFirstScatter) return block_.random(0, kFirstScatter);
        return sample_2d(block_.stream[0], block_.sample[0], dimension_);
    }

private:
    // Numbers of the first bounce come from other code, which is to be chosen outside of loops over lanes.
    static constexpr std::uint32_t kFirstLight = dimension::first_bounce + dimension::light,
                                   kFirstScatter = dimension::first_bounce + dimension::scatter;

    template <class Draw>
    REALCAM_INLINE void keep(const PathState<N>& path, Draw&& draw) {
        const int places = whole_vectors<N>(path.count);
        REALCAM_LANES
        for (int i = 0; i < places; ++i) kept_.set(i, draw(path.lane(i)));
    }

    const SampleBlock<N>& block_;
    std::uint32_t dimension_;
    Vec2Lanes<float, N> kept_;
};

}  // namespace REALCAM_NAMESPACE
