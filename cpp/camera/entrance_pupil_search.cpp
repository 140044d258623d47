#include "entrance_pupil_search.hpp"

#include <numbers>

#include "../math/hypotenuse.hpp"
#include "../optics/trace/film_frame.hpp"
#include "../optics/trace/open_iris.hpp"

namespace realcam {

double rim_depth(const Surface& surface) {
    const double r = surface.clear_semi_diameter;
    double depth = 0;
    for (const double sag : {surface.sag(0, r), surface.sag(0, -r), surface.sag(r, 0), surface.sag(-r, 0)})
        if (std::isfinite(sag)) depth = std::max(depth, std::fabs(sag));
    return depth;
}

double reach_of(const Surface& surface) {
    return 1.02 * hypotenuse(surface.clear_semi_diameter, rim_depth(surface));
}

float entry_reach(const LensSystem& lens) {
    Affine<double> front = surface_frames(lens).surfaces.front();
    if (const auto camera = film_path_ends(lens, LightDirection::to_scene).exit)
        front = inverse_motion(*camera) * front;
    return static_cast<float>(length(front.origin) + reach_of(lens.surfaces.front()));
}

EntrancePupilSearch::EntrancePupilSearch(const LensSystem& lens, double film_radius, const PupilTracer& tracer)
    : film_radius(film_radius),
      film_distance(lens.film_distance),
      film_index(lens.indices(lens.wavelength_nm).back()),
      front_reach_(entry_reach(lens)),
      rear_reach_(reach_of(lens.surfaces.back())),
      tracer(tracer) {}

std::vector<FoundRay> EntrancePupilSearch::along(const LensSystem& lens, const std::vector<Crossing>& way) const {
    const LensSystem round = with_stop_around_blades(lens);
    LensSystem open = round;
    open.stop_semi_diameter = open.stop().clear_semi_diameter;
    Directions directions;
    for (int ring = 0; ring < kGhostBins; ++ring) directions[static_cast<std::size_t>(ring)] = all_directions(ring);
    directions = around(traced<kFew>(open, way, directions), directions);
    directions = around(traced<kFew>(round, way, directions), directions);
    return traced<kMany>(round, way, directions);
}

EntrancePupilSearch::Rectangle EntrancePupilSearch::all_directions(int ring) const {
    const double r = radius_of(ring);
    const auto cosine_to = [&](double away) { return away / hypotenuse(away, film_distance); };
    return {cosine_to(-rear_reach_ - r), cosine_to(rear_reach_ - r), cosine_to(rear_reach_)};
}

void EntrancePupilSearch::start(const Rectangle& in, int rows, int square, int lane, PupilTracer::Rays& rays,
                                FoundRay& ray) const {
    const double r = radius_of(ray.film_ring), ring = film_radius / kGhostBins;
    const double column = (in.high - in.low) / (2 * rows), row = in.across / rows;
    const double x = in.low + (square % (2 * rows) + 0.5) * column, y = (square / (2 * rows) + 0.5) * row;
    const double z2 = 1 - x * x - y * y, z = std::sqrt(std::max(z2, 0.0));
    rays.origin.set(lane, static_cast<Vec3f>(Vec3d{r, 0, film_distance}));
    rays.direction.set(lane, static_cast<Vec3f>(film_index * Vec3d{x, y, -z}));
    rays.status[lane] = z2 > 0 && row > 0 ? 0 : static_cast<int>(RayStatus::vignetted);
    ray.cosines = {static_cast<float>(x), static_cast<float>(y)};
    ray.square = {static_cast<float>(column), static_cast<float>(row)};
    ray.rear = {static_cast<float>(r + x / z * film_distance), static_cast<float>(y / z * film_distance)};
    // The first factor of 2 accounts for the other half of the circle.
    ray.etendue = static_cast<float>(2 * 2 * std::numbers::pi * r * ring * column * row);
}

void set_front(Vec3f o, Vec3f d, FoundRay& ray) {
    const float sine = std::sqrt(d.x * d.x + d.y * d.y);
    const Vec2f away = sine > 0 ? Vec2f{d.x / sine, d.y / sine} : Vec2f{1, 0};
    ray.half_tangent = sine / (1 - d.z);
    ray.front = {dot(o, Vec3f{-d.z * away.x, -d.z * away.y, sine}), -away.y * o.x + away.x * o.y};
}

EntrancePupilSearch::Directions EntrancePupilSearch::around(const std::vector<FoundRay>& rays,
                                                            const Directions& before) {
    Directions own{}, around{};
    const auto unite = [](Rectangle& a, const Rectangle& b) {
        if (b.across == 0) return;
        a = a.across == 0 ? b
                          : Rectangle{std::min(a.low, b.low), std::max(a.high, b.high), std::max(a.across, b.across)};
    };
    for (const FoundRay& ray : rays) {
        const double x = static_cast<double>(ray.cosines.x), y = static_cast<double>(ray.cosines.y);
        const double wide = 1.5 * static_cast<double>(ray.square.x), high = 1.5 * static_cast<double>(ray.square.y);
        unite(own[static_cast<std::size_t>(ray.film_ring)], {x - wide, x + wide, y + high});
    }
    for (int ring = 0; ring < kGhostBins; ++ring) {
        Rectangle& here = around[static_cast<std::size_t>(ring)];
        for (int beside = std::max(0, ring - 1); beside <= std::min(kGhostBins - 1, ring + 1); ++beside)
            unite(here, own[static_cast<std::size_t>(beside)]);
        if (here.across == 0) here = before[static_cast<std::size_t>(ring)];
    }
    return around;
}

LensSystem with_stop_around_blades(LensSystem lens) {
    if (lens.iris.blades == 0 || lens.is_wide_open()) return lens;
    const double rim = lens.stop().clear_semi_diameter;
    const Iris<double> open = open_iris(lens.iris, lens.stop_semi_diameter, rim);
    const double corner = opening_radius(open.apothem, open.curvature, std::cos(std::numbers::pi / lens.iris.blades));
    lens.stop_semi_diameter = std::min(corner, rim);
    lens.iris.blades = 0;
    return lens;
}

float largest_half_tangent_of(const std::vector<FoundRay>& rays) {
    float largest = 0;
    for (const FoundRay& ray : rays) largest = std::max(largest, ray.half_tangent);
    return largest * (1 + 1.0f / kGhostBins);
}

GhostEntries entries_of(const std::vector<FoundRay>& rays, float largest_half_tangent) {
    return entrance_pupil_search_detail::entries_around(rays, &FoundRay::front, [&](const FoundRay& ray) {
        return static_cast<int>(ray.half_tangent / largest_half_tangent * static_cast<float>(kGhostBins));
    });
}

GhostEntries exits_of(const std::vector<FoundRay>& rays) {
    return entrance_pupil_search_detail::entries_around(rays, &FoundRay::rear,
                                                        [](const FoundRay& ray) { return ray.film_ring; });
}

double etendue_of(const std::vector<FoundRay>& rays) {
    double sum = 0;
    for (const FoundRay& ray : rays) sum += static_cast<double>(ray.etendue);
    return sum;
}

}  // namespace realcam
