#pragma once
#include <optional>
#include <vector>

#include "direction_box.hpp"
#include "pupil_lens.hpp"
#include "pupil_outline.hpp"

namespace REALCAM_NAMESPACE {

/// Edges of the pupil as seen from a film point: closed polygons in optical direction cosines. The first is the outer
/// edge, counter-clockwise; the second, if there is one, is the edge of a central obstruction, clockwise.
using PupilEdges = std::vector<std::vector<Vec2<double>>>;

/// Number of corners of each polygon.
inline constexpr int kPupilEdgeCorners = 2 * PupilOutline::kAzimuths;

/// Finds the edges of the light for the film point at this radius (mm) and azimuth (rad). All that blocks light is
/// included: rims, obstructions, and the blades if `lens` has them. `box`: bounding box of the light of the film point
/// with the same radius and azimuth 0. The edges are searched outwards from its centre. Returns std::nullopt if no
/// light passes at some azimuth about this centre, as in the crescent at the edge of the image circle.
std::optional<PupilEdges> pupil_edges(const PupilLens& lens, double radius, double azimuth, const DirectionBox& box);

}  // namespace REALCAM_NAMESPACE
