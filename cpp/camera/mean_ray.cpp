#include "mean_ray.hpp"

#include <cmath>

#include "../optics/analysis/film_bundle.hpp"
#include "../optics/analysis/psf.hpp"
#include "../optics/analysis/scene_bundle.hpp"

namespace realcam {

MeanRays::MeanRays(const LensSystem& lens, const PupilView& pupil, double focus)
    : to_scene_(lens, LightDirection::to_scene, lens.wavelength_nm),
      to_film_(lens, LightDirection::to_film, lens.wavelength_nm),
      pupil_(pupil),
      film_distance_(lens.film_distance),
      focus_(focus) {}

std::optional<MeanRay> MeanRays::at(double film_radius) const {
    const std::vector<Part> parts = parts_at(film_radius);
    Vec3d sum = {0, 0, 0};
    double area = 0;
    for (const Part& part : parts) {
        sum += part.area * part.ray.direction;
        area += part.area;
    }
    if (!(area > 0)) return std::nullopt;
    const Vec3d towards = normalized(Vec3d{sum.x, 0, sum.z});  // the other half of the bundle mirrors this one
    const Vec3d across = across_from(towards);
    double place = 0, slope = 0, start = 0;
    for (const Part& part : parts) {
        const double tangent = dot(part.ray.direction, across) / dot(part.ray.direction, towards);
        slope += part.area * tangent;
        place += part.area * (dot(part.ray.origin, across) - dot(part.ray.origin, towards) * tangent);
        start += part.area * dot(part.ray.origin, towards);
    }
    slope /= area;
    const SceneRay ray = {(place / area) * across + (start / area) * (towards + slope * across),
                          normalized(towards + slope * across)};
    return MeanRay{ray, middle_of_light(ray, parts), area};
}

std::vector<MeanRays::Part> MeanRays::parts_at(double film_radius) const {
    const FilmBundle bundle(to_scene_, film_distance_, pupil_, film_radius);
    std::vector<Part> parts;
    for (const EntryPart& entry : entry_parts(bundle, kSampling)) {
        const FilmBundle::Entry at[1] = {entry.entry};
        LensRays<double, 1> ray;
        bundle.trace(at, ray);
        if (ray.status[0] == 0) parts.push_back({{ray.origin[0], normalized(ray.direction[0])}, entry.area});
    }
    return parts;
}

double MeanRays::middle_of_light(const SceneRay& ray, const std::vector<Part>& parts) const {
    const Vec3d across = across_from(ray.direction);
    double area = 0, high = 0, wide = 0;
    for (const Part& part : parts) {
        const Vec3d from = part.ray.origin - ray.origin;
        const double way = -dot(from, ray.direction) / dot(part.ray.direction, ray.direction);
        const Vec3d at = from + way * part.ray.direction;
        area += part.area;
        high += part.area * dot(at, across) * dot(at, across);
        wide += part.area * at.y * at.y;
    }
    // An even ellipse reaches out to twice the root of its mean square; spokes go on to 1.7 times this.
    constexpr double kReach = 2;
    const SceneBundle bundle(to_film_, film_distance_, ray, focus_, {0, 0},
                             {kReach * std::sqrt(wide / area), kReach * std::sqrt(high / area)});
    double sum = 0, light = 0;
    for (const EntryPart& entry : entry_parts(bundle, kSampling)) {
        const double height = bundle.film_height(entry.entry);
        if (!std::isfinite(height)) continue;
        const double share = entry.area * bundle.light(entry.entry);
        sum += share * height;
        light += share;
    }
    return sum / light;
}

}  // namespace realcam
