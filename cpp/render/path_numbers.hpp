#pragma once
#include "../camera/generate_rays.hpp"

namespace REALCAM_NAMESPACE {

/// The numbers of a dimension: for many lanes all at once, which is vector code, also for those that have no use for
/// them. A GPU's thread draws them when it wants them, because it has no registers in which to keep them.
template <int N>
class PathNumbers {
public:
    REALCAM_INLINE PathNumbers(const SampleBlock<N>& block, std::uint32_t dimension)
        : block_(block), dimension_(dimension) {
        if constexpr (N > 1) {
            REALCAM_LANES
            for (int i = 0; i < N; ++i) kept_.set(i, block.random(i, dimension));
        }
    }
    REALCAM_INLINE Vec2f operator[](int lane) const {
        if constexpr (N > 1) return kept_[lane];
        return block_.random(lane, dimension_);
    }

private:
    const SampleBlock<N>& block_;
    std::uint32_t dimension_;
    Vec2Lanes<float, N> kept_;
};

}  // namespace REALCAM_NAMESPACE
