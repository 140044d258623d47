#pragma once
#include "../prescription/iris_shape.hpp"
#include "lens_view.hpp"

namespace REALCAM_NAMESPACE {

/// Distance from the axis to a blade's edge in the direction that makes an angle of this cosine with the blade's
/// middle, mm. It is the root of q r^2 + 2 (1 - q h) cos r - (2 h - q h^2) = 0, in the form that also holds for q = 0.
double opening_radius(double apothem, double curvature, double cosine);

/// Area that n blades at a distance `apothem` from the axis leave open inside a round rim, mm^2.
double iris_area(const IrisShape& shape, double apothem, double rim);

/// The opening that has the area of a circle of the given radius inside the stop's fixed rim: f-numbers then mean
/// the same light with and without blades. Wide open the blades are behind the rim.
Iris<double> open_iris(const IrisShape& shape, double circle_radius, double rim);

}  // namespace REALCAM_NAMESPACE
