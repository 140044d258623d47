#pragma once
#include <type_traits>

#include "sample_block.hpp"

namespace REALCAM_NAMESPACE {

/// Random numbers of one dimension pair for the lanes of a block, drawn at once: for many lanes this is vector code,
/// and a GPU has the code once for all callers.
template <int N>
class LaneNumbers {
public:
    REALCAM_INLINE LaneNumbers(const SampleBlock<N>& block, std::uint32_t dimension) {
        if constexpr (N > 1)
            draw(block.stream, block.sample, N, dimension, kept_);
        else
            kept_.set(0, block.random(0, dimension));
    }
    /// Draws numbers for the lanes `lane_of(i)`, i from 0 to `slots` - 1.
    template <class LaneOf>
    REALCAM_INLINE LaneNumbers(const SampleBlock<N>& block, std::uint32_t dimension, int slots, LaneOf&& lane_of) {
        Lanes<std::uint32_t, N> stream, sample;
        REALCAM_LANES
        for (int i = 0; i < slots; ++i) {
            stream[i] = block.stream[lane_of(i)];
            sample[i] = block.sample[lane_of(i)];
        }
        draw(stream, sample, slots, dimension, kept_);
    }
    REALCAM_INLINE Vec2f operator[](int slot) const { return kept_[slot]; }

private:
    using Integers = std::uint32_t[N];

    /// The code for a dimension of the joint sequence, and for few or many samples, is selected outside the loops.
    [[gnu::noinline]] static void draw(const Integers& stream, const Integers& sample, int slots,
                                       std::uint32_t dimension, Vec2Lanes<float, N>& numbers) {
        switch (dimension) {
            case 0: return draw_joint<0>(stream, sample, slots, numbers);
            case 1: return draw_joint<1>(stream, sample, slots, numbers);
            case 2: return draw_joint<2>(stream, sample, slots, numbers);
            case 3: return draw_joint<3>(stream, sample, slots, numbers);
            case 4: return draw_joint<4>(stream, sample, slots, numbers);
            default: break;
        }
        static_assert(kJointPairs == 5);
        REALCAM_LANES
        for (int i = 0; i < slots; ++i) numbers.set(i, sample_2d(stream[i], sample[i], dimension));
    }
    template <std::uint32_t pair>
    static void draw_joint(const Integers& stream, const Integers& sample, int slots, Vec2Lanes<float, N>& numbers) {
        std::uint32_t all = 0;
        for (int i = 0; i < slots; ++i) all |= sample[i];
        const auto draw_with = [&]<int bits>(std::integral_constant<int, bits>) {
            REALCAM_LANES
            for (int i = 0; i < slots; ++i) numbers.set(i, sample_joint_2d<bits>(stream[i], sample[i], pair));
        };
        if (all >> 8 == 0)
            draw_with(std::integral_constant<int, 8>{});
        else if (all >> 16 == 0)
            draw_with(std::integral_constant<int, 16>{});
        else
            draw_with(std::integral_constant<int, 32>{});
    }

    Vec2Lanes<float, N> kept_;
};

}  // namespace REALCAM_NAMESPACE
