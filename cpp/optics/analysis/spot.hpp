#pragma once
#include "field_rays.hpp"

namespace REALCAM_NAMESPACE {

/// Weighted RMS and largest distance of a spot's points from a reference point, mm.
struct SpotSize {
    double rms_radius, max_radius;
};

/// Spot diagram: film points of the rays of one object point, mm, x and y from the axis.
struct Spot {
    FieldRays rays;
    std::vector<Vec2<double>> points;  ///< one per ray; NaN if the ray does not pass
    Vec2<double> centroid;  ///< mean of the points, weighted by their fraction of the stop's area
    Vec2<double> chief;  ///< film point of the chief ray
    SpotSize about_centroid, about_chief;
};

/// Computes the spot on a film whose vertex lies `film_distance` mm behind the last vertex. Throws Cancelled if
/// `loop` is cancelled.
Spot spot_of(FieldRays rays, double film_distance, const RayLoop& loop = {});

}  // namespace REALCAM_NAMESPACE
