#include "centroid_ray.hpp"

#include <cmath>

#include "../../optics/pupil/pupil_view.hpp"
#include "../../optics/trace/film_frame.hpp"

namespace realcam {

namespace {

constexpr int kLanes = 12;  ///< Gauss nodes of a radial scan line, which the compiler vectorises
using EntryLanes = Vec2<double>[kLanes];

/// Calls work(entries, positions) for kLanes entries at a time: a pointer to the first of them, and their
/// QuadratureRay::entry. The number of entries is a multiple of kLanes.
template <class Work>
void in_lanes(const std::vector<QuadratureRay>& entries, Work&& work) {
    for (std::size_t first = 0; first + kLanes <= entries.size(); first += kLanes) {
        EntryLanes lanes;
        for (std::size_t i = 0; i < kLanes; ++i) lanes[i] = entries[first + i].entry;
        work(&entries[first], lanes);
    }
}

}  // namespace

CentroidRays::CentroidRays(const LensSystem& lens, double focus, const LensPolynomialView& polynomial)
    : to_scene_(lens, LightDirection::to_scene, lens.wavelength_nm, film_path_ends(lens, LightDirection::to_scene)),
      to_film_(lens, LightDirection::to_film, lens.wavelength_nm, film_path_ends(lens, LightDirection::to_film)),
      film_{lens.film_distance, 1 / lens.film_radius_of_curvature},
      focus_(focus),
      polynomial_(polynomial) {}

FilmBundle CentroidRays::bundle(const PupilView& pupil, double film_radius) const {
    const PupilLookup row(pupil, static_cast<float>(film_radius), 0);
    const EntryRectangle in = {{0, static_cast<double>(row.box.centre_l)},
                               {static_cast<double>(row.box.half_height), static_cast<double>(row.box.half_width)}};
    return FilmBundle(to_scene_, film_, {0, film_radius}, in, true,
                      polynomial_.disc_count > 0 ? &polynomial_ : nullptr);
}

FilmBundle CentroidRays::bundle(const PupilGridView& pupil, Vec2<double> film) const {
    const PupilLookup at(pupil, static_cast<float>(film.x), static_cast<float>(film.y));
    const Vec2f middle = at.to_film({at.box.centre_l, at.box.centre_m});
    const EntryRectangle in = {{static_cast<double>(middle.x), static_cast<double>(middle.y)},
                               {static_cast<double>(at.box.half_width), static_cast<double>(at.box.half_height)}};
    return FilmBundle(to_scene_, film_, film, in);
}

std::optional<CentroidRay> CentroidRays::centroid_ray(const FilmBundle& bundle) const {
    const std::vector<WeightedRay> rays = trace(bundle);
    Vec3d sum = {0, 0, 0};
    double area = 0;
    for (const WeightedRay& sample : rays) {
        sum += sample.area * sample.ray.direction;
        area += sample.area;
    }
    if (!(area > 0)) return std::nullopt;
    if (bundle.mirrored) sum.x = 0;
    const Vec3d towards = normalized(sum);
    const AcrossRay across(towards);
    Vec2<double> position = {0, 0}, slope = {0, 0};
    double start = 0;
    for (const WeightedRay& sample : rays) {
        const auto& [origin, direction] = sample.ray;
        const Vec2<double> at = across.of(origin), lateral = across.of(direction);
        const double along = dot(origin, towards), ahead = dot(direction, towards), weight = sample.area / area;
        const Vec2<double> tangent = {lateral.x / ahead, lateral.y / ahead};
        slope = {slope.x + weight * tangent.x, slope.y + weight * tangent.y};
        position = {position.x + weight * (at.x - along * tangent.x), position.y + weight * (at.y - along * tangent.y)};
        start += weight * along;
    }
    if (bundle.mirrored) slope.x = position.x = 0;
    const Vec3d direction = towards + across.at(slope);
    const SceneRay ray = {across.at(position) + start * direction, normalized(direction)};
    return CentroidRay{
        ray, polynomial_.disc_count > 0 ? bundle.film_point() : centroid_on_film(ray, rays, bundle.mirrored), area};
}

double CentroidRays::irradiance_of(const FilmBundle& bundle) {
    double area = 0;
    for (const QuadratureRay& part : quadrature_rays(bundle, kSampling)) area += part.area;
    return area;
}

std::vector<CentroidRays::WeightedRay> CentroidRays::trace(const FilmBundle& bundle) {
    static_assert(kSampling.nodes % kLanes == 0);
    std::vector<WeightedRay> left;
    in_lanes(quadrature_rays(bundle, kSampling), [&](const QuadratureRay* entries, const EntryLanes& lanes) {
        LensRays<double, kLanes> rays;
        bundle.trace(lanes, rays);
        for (int i = 0; i < kLanes; ++i)
            if (rays.status[i] == 0) left.push_back({{rays.origin[i], normalized(rays.direction[i])}, entries[i].area});
    });
    return left;
}

Vec2<double> CentroidRays::centroid_on_film(const SceneRay& ray, const std::vector<WeightedRay>& rays,
                                            bool mirrored) const {
    const AcrossRay across(ray.direction);
    double area = 0;
    Vec2<double> squares = {0, 0};
    for (const WeightedRay& sample : rays) {
        const Vec3d from = sample.ray.origin - ray.origin;
        const double distance = -dot(from, ray.direction) / dot(sample.ray.direction, ray.direction);
        const Vec2<double> at = across.of(from + distance * sample.ray.direction);
        area += sample.area;
        squares = {squares.x + sample.area * at.x * at.x, squares.y + sample.area * at.y * at.y};
    }
    // A uniform ellipse extends to twice its root mean square; the radial scan lines extend to 1.7 times this.
    constexpr double kHalfSizes = 2;
    const EntryRectangle in = {{0, 0},
                               {kHalfSizes * std::sqrt(squares.x / area), kHalfSizes * std::sqrt(squares.y / area)}};
    const SceneBundle bundle(to_film_, film_, ray, focus_, in, mirrored);
    Vec2<double> sum = {0, 0};
    double light = 0;
    in_lanes(quadrature_rays(bundle, kSampling), [&](const QuadratureRay* entries, const EntryLanes& lanes) {
        Vec2<double> landings[kLanes];
        bundle.land(lanes, landings);
        for (int i = 0; i < kLanes; ++i) {
            const Vec2<double> at = landings[i];
            if (!std::isfinite(at.x + at.y)) continue;
            const double weight = entries[i].area * bundle.light(entries[i].entry);
            sum = {sum.x + weight * at.x, sum.y + weight * at.y};
            light += weight;
        }
    });
    return {mirrored ? 0 : sum.x / light, sum.y / light};
}

}  // namespace realcam
