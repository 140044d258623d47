#pragma once
#include <array>
#include <optional>

#include "camera.hpp"

namespace REALCAM_NAMESPACE {

inline constexpr int kDefaultLongSide = 960;

/// Completes the user's film settings. Pixels are square unless both size and resolution are given.
/// - Neither: the film of the lens, 960 pixels along its longer side.
/// - The size in mm alone: 960 pixels along its longer side.
/// - The resolution alone: the largest part of the lens's film with its aspect ratio; upright pictures rotate the film.
/// Invalid values are passed through for validate(Camera) to report.
Film default_film(const LensSystem& lens, std::optional<std::array<double, 2>> size_mm,
                  std::optional<std::array<int, 2>> resolution);

}  // namespace REALCAM_NAMESPACE
