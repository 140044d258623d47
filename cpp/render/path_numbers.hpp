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
            const int places = whole_vectors<N>(path.count);
            REALCAM_LANES
            for (int i = 0; i < places; ++i) kept_.set(i, block.random(path.lane(i), dimension));
        }
    }
    REALCAM_INLINE Vec2f operator[](int place) const {
        if constexpr (N > 1) return kept_[place];
        return block_.random(0, dimension_);
    }

private:
    const SampleBlock<N>& block_;
    std::uint32_t dimension_;
    Vec2Lanes<float, N> kept_;
};

}  // namespace REALCAM_NAMESPACE
