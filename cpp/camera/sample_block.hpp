#pragma once
#include <cstdint>

#include "../math/lanes.hpp"
#include "../math/random.hpp"

namespace REALCAM_NAMESPACE {

/// Samples of a block of lanes. Unused lanes have used = 0 and otherwise valid numbers.
template <int N>
struct SampleBlock {
    Lanes<std::int32_t, N> column,
        row;  ///< pixel; row 0 at the top of the picture
    Lanes<std::int32_t, N> used;
    Lanes<std::uint32_t, N> stream;  ///< pixel_stream() of the pixel
    Lanes<std::uint32_t, N> sample;

    REALCAM_INLINE Vec2f random(int lane, std::uint32_t dimension) const {
        return dimension < kJointPairs ? sample_joint_2d(stream[lane], sample[lane], dimension)
                                       : sample_2d(stream[lane], sample[lane], dimension);
    }
    /// Hashed random bits of a sample, independent of the sequences.
    REALCAM_INLINE std::uint32_t bits(int lane, std::uint32_t salt) const {
        return hash32(stream[lane] ^ sample[lane], salt);
    }
};

/// Seed of the random sequence of a pixel.
REALCAM_INLINE std::uint32_t pixel_stream(std::int32_t pixel, std::uint32_t seed) {
    return hash32(static_cast<std::uint32_t>(pixel), seed);
}

/// Dimension pairs of the random sequence. Those below kJointPairs, all up to the first bounce, form one joint
/// sequence.
namespace dimension {
inline constexpr std::uint32_t film = 0, pupil = 1, first_bounce = 2, per_bounce = 2, light = 0, scatter = 1;
/// Dimension pair of the time, unused by most samples. Its second number selects the wavelength.
inline constexpr std::uint32_t time = 4;
inline constexpr std::uint32_t second_bounce = kJointPairs;
/// Russian roulette, far beyond the pairs of the last bounce.
inline constexpr std::uint32_t roulette = 0x10000;
/// Two pairs for diffraction.
inline constexpr std::uint32_t diffraction = 0x30000;

/// First pair of a bounce.
REALCAM_INLINE constexpr std::uint32_t of_bounce(int bounce) {
    return bounce == 0 ? first_bounce : second_bounce + static_cast<std::uint32_t>(bounce - 1) * per_bounce;
}
}  // namespace dimension

}  // namespace REALCAM_NAMESPACE
