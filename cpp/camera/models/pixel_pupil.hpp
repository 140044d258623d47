#pragma once
#include <algorithm>
#include <cstdint>

#include "../../math/lanes.hpp"

namespace REALCAM_NAMESPACE {

/// Learned visibility of the pupil from a pixel: one bit for each cell of the unit square from which the pupil is
/// sampled (after B. Steinert et al., "General Spectral Camera Lens Simulation", Computer Graphics Forum 30, 2011).
struct PixelPupil {
    std::uint32_t tried;   ///< cells to which rays were sent
    std::uint32_t passed;  ///< cells through which some rays passed

    /// Cells that may pass light: those that did, and those not tried yet.
    REALCAM_INLINE std::uint32_t promising() const { return passed | ~tried; }
};

/// PixelPupil of all pixels, row-major; null for a camera that does not learn.
struct PixelPupils {
    const PixelPupil* known;  ///< from earlier passes
    PixelPupil* found;        ///< from earlier passes and this one
};

namespace pixel_pupil {

inline constexpr int kColumns = 8, kRows = 4;  ///< cells of the unit square: one for each bit of PixelPupil
/// Fraction of the samples that are drawn from all cells: cells that look dark may still pass some light. Their few
/// samples have weights of up to 1 / kAnywhere.
inline constexpr float kAnywhere = 0.25f;

/// Index of the cell of a point of the unit square.
REALCAM_INLINE int cell_of(Vec2f u) {
    return static_cast<int>(u.y * kRows) * kColumns + static_cast<int>(u.x * kColumns);
}

/// Number of samples per pixel after the first pass. Later passes end at 8, 16, ...: cells are learned after each.
inline constexpr std::uint32_t kFirstPass = 4;

/// Index of the set bit that has `below` set bits below it.
REALCAM_INLINE int position_of_bit(std::uint32_t bits, std::uint32_t below) {
    int position = 0;
    for (int half = 16; half > 0; half /= 2) {
        const std::uint32_t low = bits & ((1u << half) - 1u), count = count_bits(low);
        const bool is_above = below >= count;
        below -= select(is_above, count, 0u);
        bits = select(is_above, bits >> half, low);
        position += select(is_above, half, 0);
    }
    return position;
}

}  // namespace pixel_pupil

/// Point in the unit square, and the inverse of its density.
struct GuidedSample {
    Vec2f point;
    float weight;
};

/// Defensive mixture: samples a point in the cells of a bit mask and, with probability kAnywhere, in all cells, so that
/// every cell keeps a non-zero probability. `u`: random numbers in [0, 1).
REALCAM_INLINE GuidedSample guided(std::uint32_t cells, Vec2f u) {
    using namespace pixel_pupil;
    if (cells == 0) return {u, 1.0f};
    const std::uint32_t count = count_bits(cells);
    Vec2f point = {u.x * (1.0f / kAnywhere), u.y};
    if (u.x >= kAnywhere) {
        const float along = (u.x - kAnywhere) * (1.0f / (1.0f - kAnywhere)) * static_cast<float>(count);
        const std::uint32_t below = std::min(static_cast<std::uint32_t>(along), count - 1u);
        const int cell = position_of_bit(cells, below);
        // The sum of a cell's index and a fraction must not be rounded up to the next cell.
        const auto within = [](int index, float fraction) {
            return static_cast<float>(index) + std::min(fraction, 0x1.ffffep-1f);
        };
        point = {within(cell % kColumns, along - static_cast<float>(below)) * (1.0f / kColumns),
                 within(cell / kColumns, u.y) * (1.0f / kRows)};
    }
    const bool is_chosen = (cells >> cell_of(point) & 1u) != 0;
    const float cells_density =
        select(is_chosen, (1.0f - kAnywhere) * (kColumns * kRows) / static_cast<float>(count), 0.0f);
    return {point, 1.0f / (kAnywhere + cells_density)};
}

}  // namespace REALCAM_NAMESPACE
