#pragma once
#include <algorithm>
#include <cstdint>

#include "../math/lanes.hpp"

namespace REALCAM_NAMESPACE {

/// What a pixel has learnt about where light passes the lens. It has a bit for each cell of the unit square from which
/// the pupil is sampled (after B. Steinert et al., "General Spectral Camera Lens Simulation", Computer Graphics Forum
/// 30, 2011).
struct PixelPupil {
    std::uint32_t tried;   ///< to which rays were sent
    std::uint32_t passed;  ///< and through which some came

    REALCAM_INLINE std::uint32_t promising() const { return passed | ~tried; }
};

/// The pupils of all pixels, row by row; null for a camera that does not learn.
struct PixelPupils {
    const PixelPupil* known;  ///< from earlier passes
    PixelPupil* found;        ///< the same, and of this pass
};

namespace pixel_pupil {

inline constexpr int kColumns = 8, kRows = 4;
/// The share of samples that are drawn from all cells. Cells that look dark may still let some light pass. Their few
/// samples then have weights of up to one over this share.
inline constexpr float kAnywhere = 0.25f;

REALCAM_INLINE int cell_of(Vec2f u) {
    return static_cast<int>(u.y * kRows) * kColumns + static_cast<int>(u.x * kColumns);
}

/// Passes end at 4, 8, 16, ... samples.
inline constexpr std::uint32_t kFirstPass = 4;

/// Number of the bit that has `below` others below it.
REALCAM_INLINE int place_of_bit(std::uint32_t bits, std::uint32_t below) {
    int place = 0;
    for (int half = 16; half > 0; half /= 2) {
        const std::uint32_t low = bits & ((1u << half) - 1u), count = count_bits(low);
        const bool is_above = below >= count;
        below -= select(is_above, count, 0u);
        bits = select(is_above, bits >> half, low);
        place += select(is_above, half, 0);
    }
    return place;
}

}  // namespace pixel_pupil

/// A place in the unit square, and one over its density.
struct GuidedPlace {
    Vec2f place;
    float weight;
};

/// Mixes some cells with all cells, so that no light is missed whatever was learnt.
REALCAM_INLINE GuidedPlace guided(std::uint32_t cells, Vec2f u) {
    using namespace pixel_pupil;
    if (cells == 0) return {u, 1.0f};
    const std::uint32_t count = count_bits(cells);
    Vec2f place = {u.x * (1.0f / kAnywhere), u.y};
    if (u.x >= kAnywhere) {
        const float along = (u.x - kAnywhere) * (1.0f / (1.0f - kAnywhere)) * static_cast<float>(count);
        const std::uint32_t below = std::min(static_cast<std::uint32_t>(along), count - 1u);
        const int cell = place_of_bit(cells, below);
        // The sum of a cell's number and a share must not be rounded up to the next cell.
        const auto within = [](int number, float share) {
            return static_cast<float>(number) + std::min(share, 0x1.ffffep-1f);
        };
        place = {within(cell % kColumns, along - static_cast<float>(below)) * (1.0f / kColumns),
                 within(cell / kColumns, u.y) * (1.0f / kRows)};
    }
    const bool is_chosen = (cells >> cell_of(place) & 1u) != 0;
    const float of_cells = select(is_chosen, (1.0f - kAnywhere) * (kColumns * kRows) / static_cast<float>(count), 0.0f);
    return {place, 1.0f / (kAnywhere + of_cells)};
}

}  // namespace REALCAM_NAMESPACE
