#pragma once
#include "field_rays.hpp"

namespace REALCAM_NAMESPACE {

/// Distances of a spot's points from one of them, mm.
struct SpotSize {
    double rms_radius, max_radius;
};

/// Where the rays of one object point meet the film, mm, x and y from the axis.
struct Spot {
    FieldRays rays;
    std::vector<Vec2<double>> points;  ///< NaN where the ray does not pass
    Vec2<double> centroid;             ///< mean of the points, weighted by their share of the stop's area
    Vec2<double> chief;                ///< of the chief ray
    SpotSize about_centroid, about_chief;
};

/// The spot on the film, whose vertex is put `film_distance` mm behind the last one. Throws what `loop` throws to stop
/// it.
Spot spot_of(FieldRays rays, double film_distance, const RayLoop& loop = {});

}  // namespace REALCAM_NAMESPACE
