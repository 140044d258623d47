#include "film_bundle.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../../math/hypotenuse.hpp"
#include "../lens/parabasal.hpp"

namespace realcam {

LensSystem with_round_stop(LensSystem lens) {
    lens.iris = {};
    return lens;
}

namespace {

/// Returns approximate bounds of the light of a film point, extrapolated from rays close to its chief ray (parabasal
/// rays) to the edge of the stop.
EntryRectangle rectangle_about(const ChiefRay& chief, const ParabasalRays& rays, double index, double stop_radius,
                               const FilmSurface<double>& film, Vec2<double> film_point) {
    const Matrix2 direction_by_stop = rays.stop_by_film_direction.inverse();
    const Vec3d x = film.direction(film_point, {1, 0, 0}), y = film.direction(film_point, {0, 1, 0});
    const Vec3d direction = -index * chief.film_direction;
    return {{dot(direction, x), dot(direction, y)},
            {stop_radius * hypotenuse(direction_by_stop.first.x, direction_by_stop.first.y),
             stop_radius * hypotenuse(direction_by_stop.second.x, direction_by_stop.second.y)}};
}

/// Returns the outline of the light as segments that join its edges on neighbouring radial scan lines. An interval that
/// exists on only one of the two lines is closed by a segment along that line.
std::vector<std::array<Vec2<double>, 2>> outline_of(const FilmBundle& light, const std::vector<QuadratureArm>& arms) {
    std::vector<std::array<Vec2<double>, 2>> segments;
    const auto towards_film = [&](const QuadratureArm& arm, double r) {
        const Vec2<double> entry = arm.at(light, r);
        return Vec2<double>{-entry.x, -entry.y};
    };
    for (std::size_t s = 0; s < arms.size(); ++s) {
        const QuadratureArm &here = arms[s], &next = arms[(s + 1) % arms.size()];
        const std::size_t paired = std::min(here.intervals.size(), next.intervals.size());
        for (std::size_t i = 0; i < paired; ++i) {
            const RadialInterval &a = here.intervals[i], &b = next.intervals[i];
            if (a.from != 0 || b.from != 0)
                segments.push_back({towards_film(here, a.from), towards_film(next, b.from)});
            segments.push_back({towards_film(here, a.to), towards_film(next, b.to)});
        }
        for (const QuadratureArm* longer : {&here, &next})
            for (std::size_t i = paired; i < longer->intervals.size(); ++i)
                segments.push_back(
                    {towards_film(*longer, longer->intervals[i].from), towards_film(*longer, longer->intervals[i].to)});
    }
    return segments;
}

}  // namespace

FilmPupil film_pupil(const LensSystem& lens, double wavelength_nm, Vec2<double> film, const RayLoop& loop) {
    constexpr int kArms = 128;
    const RaysFromFilm rays(lens, wavelength_nm);
    const std::optional<ChiefRay> chief = chief_ray_of_film_point(rays, film);
    if (!chief) return {};
    const LensPath<double> path(lens, LightDirection::to_scene, wavelength_nm,
                                film_path_ends(lens, LightDirection::to_scene));
    const FilmSurface<double> surface{lens.film_distance, 1 / lens.film_radius_of_curvature};
    const FilmBundle light(path, surface, film,
                           rectangle_about(*chief, parabasal_rays(lens, rays, *chief), path.entry_index,
                                           rays.stop_radius(), surface, film));
    const std::vector<QuadratureArm> arms = quadrature_arms(light, kArms, loop);
    double squares = 0;
    for (const QuadratureArm& arm : arms)
        for (const RadialInterval& interval : arm.intervals)
            squares += interval.to * interval.to - interval.from * interval.from;
    const double area_factor = std::numbers::pi / static_cast<double>(arms.size());
    return {area_factor * light.reach.x * light.reach.y * squares, outline_of(light, arms)};
}

}  // namespace realcam
