#pragma once
#include "../prescription/lens_system.hpp"
#include "lens_view.hpp"

namespace REALCAM_NAMESPACE {

// The opening of an iris whose blades have edges that are arcs of the curvature q, 1/mm. The apothem h, mm, is the
// distance from the axis to the midpoint of an edge.

/// Returns the distance r from the axis to a blade's edge, mm. `cosine`: cosine of the angle between the direction in
/// which r is measured and that of the edge's midpoint. r is the root of q r^2 + 2 (1 - q h) cosine r - (2 h - q h^2) =
/// 0, in the form that also holds for q = 0.
double opening_radius(double apothem, double curvature, double cosine);

/// Returns the area of the opening of the iris with this apothem inside a round rim of radius `rim`, mm^2.
double iris_area(const IrisShape& shape, double apothem, double rim);

/// Returns the iris whose opening inside the stop's fixed rim, of radius `rim`, has the area of a circle of radius
/// `circle_radius`, mm: an f-number then means the same amount of light with and without blades. If `circle_radius` is
/// `rim`, the blades are hidden behind the rim.
Iris<double> open_iris(const IrisShape& shape, double circle_radius, double rim);

}  // namespace REALCAM_NAMESPACE
