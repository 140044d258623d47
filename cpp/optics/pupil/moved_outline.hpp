#pragma once
#include <array>

#include "direction_box.hpp"
#include "pupil_outline.hpp"

namespace REALCAM_NAMESPACE {

/// The outline of a whole region: of its half above the middle of a box, and of the one below.
using OutlineHalves = std::array<PupilOutline, 2>;

/// The same outline about the middle of another box, and in units of it. Between azimuths it is straight. Nothing where
/// the region does not go all around both middles.
OutlineHalves moved_outline(const OutlineHalves& outline, const DirectionBox& from, const DirectionBox& to);

}  // namespace REALCAM_NAMESPACE
