#pragma once
#include "field_rays.hpp"

namespace REALCAM_NAMESPACE {

/// Distances of a spot's points from one of them, mm.
struct SpotSize {
    double rms_radius, max_radius;
};

/// Where the rays of one object point meet a plane behind the lens, mm, x and y from the axis.
struct Spot {
    FieldRays rays;
    std::vector<Vec2<double>> points;  ///< NaN where the ray does not pass
    Vec2<double> centroid;             ///< mean of the points, weighted by their share of the stop's area
    Vec2<double> chief;                ///< of the chief ray
    SpotSize about_centroid, about_chief;
};

namespace spot_detail {

inline SpotSize size_about(const Spot& spot, Vec2<double> middle, const RayLoop& loop) {
    double sum = 0, weight = 0, largest = 0;
    loop.in_order(spot.points.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            if (!spot.rays.passes(i)) continue;
            const double radius = std::hypot(spot.points[i].x - middle.x, spot.points[i].y - middle.y);
            sum += spot.rays.pattern[i].weight * radius * radius;
            weight += spot.rays.pattern[i].weight;
            largest = std::max(largest, radius);
        }
    });
    return {std::sqrt(sum / weight), largest};
}

}  // namespace spot_detail

/// The spot on the plane `film_distance` mm behind the last vertex. Throws what `loop` throws to stop it.
inline Spot spot_of(FieldRays rays, double film_distance, const RayLoop& loop = {}) {
    Spot spot{};
    const auto on_film = [&](const AimedRay& ray) {
        const Vec3d at = crossing(ray, film_distance);
        return Vec2<double>{at.x, at.y};
    };
    spot.rays = std::move(rays);
    spot.chief = on_film(spot.rays.chief);
    spot.points.reserve(spot.rays.rays.size());
    double weight = 0;
    loop.in_order(spot.rays.rays.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            constexpr double nan = std::numeric_limits<double>::quiet_NaN();
            const bool passes = spot.rays.passes(i);
            spot.points.push_back(passes ? on_film(spot.rays.rays[i]) : Vec2<double>{nan, nan});
            if (!passes) continue;
            const double share = spot.rays.pattern[i].weight;
            spot.centroid.x += share * spot.points[i].x;
            spot.centroid.y += share * spot.points[i].y;
            weight += share;
        }
    });
    spot.centroid = {spot.centroid.x / weight, spot.centroid.y / weight};
    spot.about_centroid = spot_detail::size_about(spot, spot.centroid, loop);
    spot.about_chief = spot_detail::size_about(spot, spot.chief, loop);
    return spot;
}

}  // namespace REALCAM_NAMESPACE
