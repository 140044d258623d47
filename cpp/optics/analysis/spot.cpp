#include "spot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "../../math/hypotenuse.hpp"

namespace realcam {

namespace {

/// Returns the size of a spot about a point (mm).
SpotSize size_about(const Spot& spot, Vec2<double> centre, const RayLoop& loop) {
    double sum = 0, weight = 0, largest = 0;
    loop.in_order(spot.points.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            if (!spot.rays.passes(i)) continue;
            const double radius = hypotenuse(spot.points[i].x - centre.x, spot.points[i].y - centre.y);
            sum += spot.rays.pattern[i].weight * radius * radius;
            weight += spot.rays.pattern[i].weight;
            largest = std::max(largest, radius);
        }
    });
    return {std::sqrt(sum / weight), largest};
}

}  // namespace

Spot spot_of(FieldRays rays, double film_distance, const RayLoop& loop) {
    Spot spot{};
    spot.rays = std::move(rays);
    const auto on_film = [&](const AimedRay& ray) {
        const Vec3d at = spot.rays.on_film(ray, film_distance);
        return Vec2<double>{at.x, at.y};
    };
    spot.chief = on_film(spot.rays.chief);
    spot.points.reserve(spot.rays.rays.size());
    double weight = 0;
    loop.in_order(spot.rays.rays.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            constexpr double nan = std::numeric_limits<double>::quiet_NaN();
            const bool passes = spot.rays.passes(i);
            spot.points.push_back(passes ? on_film(spot.rays.rays[i]) : Vec2<double>{nan, nan});
            if (!passes) continue;
            const double ray_weight = spot.rays.pattern[i].weight;
            spot.centroid.x += ray_weight * spot.points[i].x;
            spot.centroid.y += ray_weight * spot.points[i].y;
            weight += ray_weight;
        }
    });
    spot.centroid = {spot.centroid.x / weight, spot.centroid.y / weight};
    spot.about_centroid = size_about(spot, spot.centroid, loop);
    spot.about_chief = size_about(spot, spot.chief, loop);
    return spot;
}

}  // namespace realcam
