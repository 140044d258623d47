#pragma once
#include <array>
#include <cstddef>
#include <optional>

namespace realcam::image_io {

/// CIE x and y of red, green, blue and white, in this order: OpenEXR's attribute `chromaticities`, and Radiance's line
/// PRIMARIES.
using Chromaticities = std::array<double, 8>;

/// Those of the tristimulus values X, Y and Z themselves.
inline constexpr Chromaticities kXyzChromaticities = {1, 0, 0, 1, 0, 0, 1.0 / 3, 1.0 / 3};

/// By rows: what takes light in such colours to linear Rec. 709. Their white becomes Rec. 709's by Bradford's
/// adaptation, but for X, Y and Z, which are what they are. Nothing where they are Rec. 709's own. Throws Error where
/// they span no colours.
std::optional<std::array<double, 9>> rec709_from(const Chromaticities& chromaticities);

/// Applies such a matrix to the first three numbers of each pixel, of which the next is `stride` numbers on.
void apply_matrix(const std::array<double, 9>& matrix, float* pixels, std::size_t count, std::size_t stride);

}  // namespace realcam::image_io
