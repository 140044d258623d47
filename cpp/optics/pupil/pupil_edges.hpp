#pragma once
#include <optional>
#include <vector>

#include "direction_box.hpp"
#include "pupil_lens.hpp"
#include "pupil_outline.hpp"

namespace REALCAM_NAMESPACE {

/// Edges of the pupil as seen from a film point, as closed polygons in optical direction cosines: counter-clockwise
/// around the light, clockwise around a central obstruction.
using PupilEdges = std::vector<std::vector<Vec2<double>>>;

/// Number of corners of the polygons.
inline constexpr int kPupilEdgeCorners = 2 * PupilOutline::kAzimuths;

/// Finds the edges for the film point at this radius (mm) and azimuth (rad): rims, and blades if the lens has them, and
/// all else that blocks light. `box`: bounding box of the light for azimuth 0, from whose centre the edges are
/// searched. Returns std::nullopt if there is a direction from there without light, as in a crescent at the edge of the
/// image.
std::optional<PupilEdges> pupil_edges(const PupilLens& lens, double radius, double azimuth, const DirectionBox& box);

}  // namespace REALCAM_NAMESPACE
