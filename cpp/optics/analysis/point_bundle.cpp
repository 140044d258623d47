#include "point_bundle.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../../math/hypotenuse.hpp"
#include "../prescription/glass_resonances.hpp"
#include "wavefront.hpp"

namespace realcam {

PointBundle::PointBundle(const LensSystem& lens, double wavelength_nm, const FieldPoint& field, double film_distance,
                         const RayLoop& loop, int look)
    : mirrored(lens.is_rotational() && !field.film && (lens.iris.blades == 0 || lens.is_wide_open())),
      object(in_known_glass(lens, wavelength_nm), wavelength_nm, field),
      path_(lens, LightDirection::to_film, wavelength_nm, film_path_ends(lens, LightDirection::to_film)),
      open_(AimingPath::open(path_)),
      real_(AimingPath::real(path_)) {
    index = lens.indices(wavelength_nm).back();
    wave_number = 2e6 * std::numbers::pi * index / wavelength_nm;
    const FieldRays rays = look_for(lens, wavelength_nm, field, look, loop);
    plane_ = rays.on_film(rays.chief, film_distance).z;
    chief_entry = rays.chief.entry;
    const FilmRay at_chief = on_film(rays.chief.origin, rays.chief.direction, rays.chief.path);
    chief = {mirrored ? 0 : at_chief.at.x, at_chief.at.y};
    chief_path_ = at_chief.path;
    chief_direction_ = at_chief.direction;
    curvature_ = wavefront_detail::reference_curvature(lens, wavelength_nm, rays, film_distance, ExitPupil::real);
    if (!std::isfinite(curvature_))
        throw InputError("psf: the exit pupil of lens \"" + lens.name + "\" lies in the film plane");
    measure(rays, look);
}

WaveRay PointBundle::as_wave(const FilmRay& ray) const {
    const Vec2<double> q = ray.at;
    const double tilt = chief_direction_.x * q.x + chief_direction_.y * q.y, square = q.x * q.x + q.y * q.y;
    // |q + R d| - R and its gradient, with d the chief ray's direction, in a form that also holds for R = infinity.
    const double root = std::sqrt(1 + curvature_ * (2 * tilt + curvature_ * square));
    const double sphere = (2 * tilt + curvature_ * square) / (1 + root);
    const Vec2<double> slope = {ray.direction.x - (chief_direction_.x + curvature_ * q.x) / root,
                                ray.direction.y - (chief_direction_.y + curvature_ * q.y) / root};
    return {slope, ray.path - sphere - slope.x * q.x - slope.y * q.y};
}

double PointBundle::energy(Entry entry) const {
    const double d = object.inverse_distance;
    return std::pow(1 + (entry.x * entry.x + entry.y * entry.y) * d * d, -1.5);
}

const LensSystem& PointBundle::in_known_glass(const LensSystem& lens, double wavelength_nm) {
    check_wavelength_in_glasses(lens, wavelength_nm, "psf");
    return lens;
}

FieldRays PointBundle::look_for(const LensSystem& lens, double wavelength_nm, const FieldPoint& field, int look,
                                const RayLoop& loop) {
    try {
        FieldRays rays = field_rays(lens, wavelength_nm, field, square_grid(look, loop), loop);
        std::size_t passing = 0;
        for (std::size_t i = 0; i < rays.rays.size(); ++i) passing += rays.passes(i);
        if (passing >= few(look)) return rays;
    } catch (const InputError&) {
        // If a denser probe cannot help, field_rays throws the same error again below.
    }
    return field_rays(lens, wavelength_nm, field, square_grid(kCloseLook, loop), loop);
}

void PointBundle::measure(const FieldRays& rays, int look) {
    Entry low = {kInfinity, kInfinity}, high = {-kInfinity, -kInfinity};
    slope_low = low, slope_high = high;
    spot = centroid = {0, 0};
    double weight = 0;
    for (std::size_t i = 0; i < rays.rays.size(); ++i) {
        if (!rays.passes(i)) continue;
        const AimedRay& ray = rays.rays[i];
        const auto widen = [](Vec2<double>& least, Vec2<double>& most, Vec2<double> v) {
            least = {std::min(least.x, v.x), std::min(least.y, v.y)};
            most = {std::max(most.x, v.x), std::max(most.y, v.y)};
        };
        widen(low, high, ray.entry);
        const FilmRay found = from_chief(true, ray.origin, ray.direction, ray.path);
        widen(slope_low, slope_high, as_wave(found).slope);
        spot = {std::max(spot.x, std::fabs(found.at.x)), std::max(spot.y, std::fabs(found.at.y))};
        centroid = {centroid.x + found.at.x, centroid.y + found.at.y};
        weight += 1;
    }
    centroid = {centroid.x / weight, centroid.y / weight};
    middle = {0.5 * (low.x + high.x), 0.5 * (low.y + high.y)};
    // Margin beyond the outermost rays: half a cell on either side, and a small one in case all rays lie on one line.
    const double beyond = 1 + 2.0 / look, hair = 1e-3 * hypotenuse(high.x - low.x, high.y - low.y);
    if (mirrored) middle.x = centroid.x = 0;
    reach = {beyond * 0.5 * (high.x - low.x) + hair, beyond * 0.5 * (high.y - low.y) + hair};
}

FilmRay PointBundle::on_film(Vec3d origin, Vec3d direction, double path) const {
    const double parameter = (plane_ - origin.z) / direction.z, n = length(direction);
    const Vec3d at = origin + parameter * direction;
    return {true, {at.x, at.y}, (1 / n) * direction, path / index + parameter * n};
}

FilmRay PointBundle::from_chief(bool passes, Vec3d origin, Vec3d direction, double path) const {
    FilmRay ray = on_film(origin, direction, path);
    ray.passes = passes;
    ray.at = {ray.at.x - chief.x, ray.at.y - chief.y};
    ray.path -= chief_path_;
    return ray;
}

}  // namespace realcam
