#pragma once
#include "../prescription/lens_system.hpp"
#include "lens_view.hpp"

namespace REALCAM_NAMESPACE {

/// Distance from the axis to a blade's edge, mm, in a direction at an angle of this cosine to the direction of the
/// blade's midpoint. The root of q r^2 + 2 (1 - q h) cos r - (2 h - q h^2) = 0, in the form that also holds for q = 0.
double opening_radius(double apothem, double curvature, double cosine);

/// Area of the opening of n blades with this apothem inside a round rim, mm^2.
double iris_area(const IrisShape& shape, double apothem, double rim);

/// Returns the iris whose opening inside the stop's fixed rim has the area of a circle of radius `circle_radius`: an
/// f-number then means the same amount of light with and without blades. Wide open, the blades are behind the rim.
Iris<double> open_iris(const IrisShape& shape, double circle_radius, double rim);

}  // namespace REALCAM_NAMESPACE
