#pragma once
#include <cstdint>
#include <type_traits>

#include "../../math/lanes.hpp"
#include "../../math/random.hpp"

namespace REALCAM_NAMESPACE {

// Random numbers of pixel samples: quasi-random sequences by pixel, sample index and dimension pair.

/// Samples of a block of lanes. Unused lanes have used = 0 and otherwise valid numbers.
template <int N>
struct SampleBlock {
    Lanes<std::int32_t, N> column,
        row;  ///< pixel; row 0 at the top of the picture
    Lanes<std::int32_t, N> used;  ///< 1 if the lane holds a sample
    Lanes<std::uint32_t, N> stream;  ///< pixel_stream() of the pixel
    Lanes<std::uint32_t, N> sample;  ///< index of the sample in its pixel

    /// Two random numbers in [0, 1) of a lane's sample.
    REALCAM_INLINE Vec2f random(int lane, std::uint32_t dimension) const {
        return dimension < kJointPairs ? sample_joint_2d(stream[lane], sample[lane], dimension)
                                       : sample_2d(stream[lane], sample[lane], dimension);
    }
    /// Hashed random bits of a lane's sample, independent of the sequences. `salt`: selects one of many such numbers.
    REALCAM_INLINE std::uint32_t bits(int lane, std::uint32_t salt) const {
        return hash32(stream[lane] ^ sample[lane], salt);
    }
};

/// Seed of the random sequence of a pixel.
REALCAM_INLINE std::uint32_t pixel_stream(std::int32_t pixel, std::uint32_t seed) {
    return hash32(static_cast<std::uint32_t>(pixel), seed);
}

/// Indices of the dimension pairs of the random sequence. Pairs below kJointPairs, all up to the first bounce, form one
/// joint sequence. `light` and `scatter` are relative to the first pair of a bounce.
namespace dimension {
inline constexpr std::uint32_t film = 0, pupil = 1, first_bounce = 2, per_bounce = 2, light = 0, scatter = 1;
/// Dimension pair of the time, unused by most samples. Its second number selects the wavelength.
inline constexpr std::uint32_t time = 4;
inline constexpr std::uint32_t second_bounce = kJointPairs;
/// Russian roulette, far beyond the pairs of the last bounce.
inline constexpr std::uint32_t roulette = 0x10000;
/// Three pairs for each bounce, for the medium around the ray (cross_medium).
inline constexpr std::uint32_t medium = 0x20000;
/// Two pairs for diffraction.
inline constexpr std::uint32_t diffraction = 0x30000;

/// First pair of a bounce.
REALCAM_INLINE constexpr std::uint32_t of_bounce(int bounce) {
    return bounce == 0 ? first_bounce : second_bounce + static_cast<std::uint32_t>(bounce - 1) * per_bounce;
}
}  // namespace dimension

/// Random numbers of one dimension pair for the lanes of a block, drawn at once: for many lanes this is vector code,
/// and a GPU has the code once for all callers.
template <int N>
class LaneNumbers {
public:
    REALCAM_INLINE LaneNumbers(const SampleBlock<N>& block, std::uint32_t dimension) {
        if constexpr (N > 1)
            draw(block.stream, block.sample, N, dimension, values_);
        else
            values_.set(0, block.random(0, dimension));
    }
    /// Draws numbers for a selection of lanes: element i, from 0 to `slots` - 1, belongs to the lane `lane_of(i)`.
    template <class LaneOf>
    REALCAM_INLINE LaneNumbers(const SampleBlock<N>& block, std::uint32_t dimension, int slots, LaneOf&& lane_of) {
        Lanes<std::uint32_t, N> stream, sample;
        REALCAM_LANES
        for (int i = 0; i < slots; ++i) {
            stream[i] = block.stream[lane_of(i)];
            sample[i] = block.sample[lane_of(i)];
        }
        draw(stream, sample, slots, dimension, values_);
    }
    /// Two random numbers in [0, 1) of a lane or, for a selection of lanes, of an element.
    REALCAM_INLINE Vec2f operator[](int slot) const { return values_[slot]; }
    /// Replaces the numbers u of each lane by f(lane, u).
    template <class F>
    REALCAM_INLINE void transform(F&& f) {
        REALCAM_LANES
        for (int i = 0; i < N; ++i) values_.set(i, f(i, values_[i]));
    }

private:
    using Integers = std::uint32_t[N];

    /// Sets `numbers` for `slots` samples. The code for a dimension of the joint sequence, and for few or many samples,
    /// is selected outside the loops.
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

    Vec2Lanes<float, N> values_;
};

}  // namespace REALCAM_NAMESPACE
