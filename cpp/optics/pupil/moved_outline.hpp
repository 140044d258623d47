#pragma once
#include <array>

#include "../../math/vec3.hpp"
#include "direction_box.hpp"
#include "pupil_outline.hpp"

namespace REALCAM_NAMESPACE {

/// Outline of a whole region: of its halves above and below the centre of its box.
using OutlineHalves = std::array<PupilOutline, 2>;

/// An azimuth over a whole turn: its half of the outline, its index in that half, and its direction.
struct TurnAzimuth {
    std::size_t half;
    int azimuth;
    Vec2<double> direction;

    /// `i`: from 0 to 2 PupilOutline::kAzimuths - 1.
    explicit TurnAzimuth(int i);
};

/// Returns the outline relative to the centre of another box, in units of that box. It is taken as straight between
/// azimuths. Returns an empty outline if the region does not surround the centres of both boxes.
OutlineHalves moved_outline(const OutlineHalves& outline, const DirectionBox& from, const DirectionBox& to);

}  // namespace REALCAM_NAMESPACE
