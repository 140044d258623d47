#pragma once
#include <array>
#include <cstddef>
#include <optional>

namespace realcam::image_io {

/// CIE x and y of red, green, blue and white, in this order: OpenEXR's attribute `chromaticities`, and Radiance's line
/// PRIMARIES.
using Chromaticities = std::array<double, 8>;

/// Chromaticities of files whose channels are the tristimulus values X, Y and Z.
inline constexpr Chromaticities kXyzChromaticities = {1, 0, 0, 1, 0, 0, 1.0 / 3, 1.0 / 3};

/// Returns the matrix, by rows, from colours with these chromaticities to linear Rec. 709. White is adapted to that of
/// Rec. 709 by Bradford's method, except for X, Y and Z, which are absolute. Returns std::nullopt if the chromaticities
/// are those of Rec. 709. Throws Error if they span no colours.
std::optional<std::array<double, 9>> rec709_from(const Chromaticities& chromaticities);

/// Applies a 3 x 3 matrix to the first three numbers of each pixel. `stride`: distance between pixels, in numbers.
void apply_matrix(const std::array<double, 9>& matrix, float* pixels, std::size_t count, std::size_t stride);

}  // namespace realcam::image_io
