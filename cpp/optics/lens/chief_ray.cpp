#include "chief_ray.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "../../math/hypotenuse.hpp"
#include "../../math/matrix2.hpp"
#include "../prescription/lens_system.hpp"
#include "../pupil/film_surface.hpp"

namespace realcam {

RaysFromFilm::RaysFromFilm(const LensSystem& lens, double wavelength_nm)
    : ends_(film_path_ends(lens, LightDirection::to_scene)),
      path_(lens, LightDirection::to_scene, wavelength_nm, ends_),
      open_(AimingPath::open(path_)),
      within_rims_(AimingPath::with_open_stop(path_, lens.stop_index())),
      last_(lens.surfaces.back()),
      film_distance_(lens.film_distance),
      film_curvature_(1 / lens.film_radius_of_curvature),
      scene_index_(lens.indices(wavelength_nm).front()),
      stop_radius_(lens.open_stop_radius()),
      to_stop_(static_cast<int>(lens.surfaces.size()) - lens.stop_index()) {
    if (ends_.entry) frame_of_last_ = inverse_motion(*ends_.entry) * surface_frames(lens).surfaces.back();
}

Vec3d RaysFromFilm::film_point(Vec2<double> film) const {
    return FilmSurface<double>{film_distance_, film_curvature_}.point(film);
}

Vec3d RaysFromFilm::on_last_surface(Vec2<double> relative) const {
    const double x = last_.clear_semi_diameter * relative.x, y = last_.clear_semi_diameter * relative.y;
    const double sag = last_.sag(x, y);
    return frame_of_last_.point({x, y, std::isfinite(sag) ? sag : 0.0});
}

namespace {

/// Aims rays from one film point at the stop's centre. Rays are parametrised by their optical direction cosines: x and
/// y of the optical direction, current called l and m.
class StopAim {
public:
    StopAim(const RaysFromFilm& rays, Vec3d film) : rays_(rays), film_(film) {}

    /// Returns the rays with these cosines at the film. Their status is missed if no direction has such cosines.
    template <int N>
    LensRays<double, N> from_film(const Vec2<double> (&cosines)[N]) const {
        const double n = rays_.film_index();
        LensRays<double, N> rays;
        for (int i = 0; i < N; ++i) {
            const auto [l, m] = cosines[i];
            const double z_squared = n * n - l * l - m * m;
            rays.origin.set(i, film_);
            rays.direction.set(i, {l, m, -sqrt_or_zero(z_squared)});
            rays.status[i] = z_squared > 0 ? 0 : static_cast<int>(RayStatus::missed);
        }
        return rays;
    }

    /// A ray at the plane of the stop.
    struct Probe {
        Vec2<double> miss;  ///< offset from the stop's centre, mm
        Matrix2 slope;  ///< derivative of `miss` by the cosines

        double error() const { return hypotenuse(miss.x, miss.y); }
    };

    /// Traces the ray with these cosines to the stop, and two more for the derivatives. Returns std::nullopt if one of
    /// them does not reach the stop.
    std::optional<Probe> probe(Vec2<double> cosines) const {
        constexpr double kStep = 1e-6;
        const Vec2<double> neighbours[] = {cosines, {cosines.x + kStep, cosines.y}, {cosines.x, cosines.y + kStep}};
        LensRays<double, 3> rays = from_film(neighbours);
        rays_.to_stop(rays);
        for (const int status : rays.status)
            if (status != 0) return {};
        const auto& p = rays.origin;
        return Probe{{p.x[0], p.y[0]},
                     {{(p.x[1] - p.x[0]) / kStep, (p.x[2] - p.x[0]) / kStep},
                      {(p.y[1] - p.y[0]) / kStep, (p.y[2] - p.y[0]) / kStep}}};
    }

    /// Returns the cosines of the ray that comes nearest to the stop's centre: from a regular grid of directions to the
    /// last surface, then from finer and finer grids about the best one. `within_rims`: only rays that pass all rims in
    /// front of the stop. Returns std::nullopt if no ray reaches the stop.
    std::optional<Vec2<double>> nearest(bool within_rims) const {
        constexpr int kAcross = 13, kRays = kAcross * kAcross, kLevels = 3;
        std::optional<Vec2<double>> best;
        double smallest_miss = std::numeric_limits<double>::infinity();
        auto [low, high] = box_of_last_surface();
        Vec2<double> middle{0.5 * (low.x + high.x), 0.5 * (low.y + high.y)};
        Vec2<double> half{0.5 * (high.x - low.x), 0.5 * (high.y - low.y)};
        for (int level = 0; level < kLevels; ++level) {
            Vec2<double> cosines[kRays];
            for (int i = 0; i < kRays; ++i) {
                const auto step = [](int k) { return 2.0 * k / (kAcross - 1) - 1; };
                cosines[i] = {middle.x + half.x * step(i % kAcross), middle.y + half.y * step(i / kAcross)};
            }
            LensRays<double, kRays> rays = from_film(cosines);
            within_rims ? rays_.to_stop_within_rims(rays) : rays_.to_stop(rays);
            for (int i = 0; i < kRays; ++i) {
                const double miss = hypotenuse(rays.origin.x[i], rays.origin.y[i]);
                if (rays.status[i] != 0 || !(miss < smallest_miss)) continue;
                smallest_miss = miss;
                best = middle = cosines[i];
            }
            constexpr double kFiner = 2.0 / (kAcross - 1);
            half = {kFiner * half.x, kFiner * half.y};
        }
        return best;
    }

private:
    /// Returns the bounds (lowest, highest) of the cosines of rays from the film point to the rim and the vertex of the
    /// last surface.
    std::pair<Vec2<double>, Vec2<double>> box_of_last_surface() const {
        constexpr int kAround = 32;  // points of the rim
        Vec2<double> low{1e9, 1e9}, high{-1e9, -1e9};
        for (int i = 0; i <= kAround; ++i) {
            const double angle = 2 * std::numbers::pi * i / kAround, radius = i == kAround ? 0 : 1;
            const Vec3d target = rays_.on_last_surface({radius * std::cos(angle), radius * std::sin(angle)});
            const Vec3d direction = rays_.film_index() * normalized(target - film_);
            low = {std::min(low.x, direction.x), std::min(low.y, direction.y)};
            high = {std::max(high.x, direction.x), std::max(high.y, direction.y)};
        }
        return {low, high};
    }

    const RaysFromFilm& rays_;
    Vec3d film_;  ///< the film point, in the film frame
};

/// Finds the chief ray by Newton's method with step halving, starting with these direction cosines. Returns
/// std::nullopt if it does not converge to a ray that leaves the lens.
std::optional<ChiefRay> solve_chief_ray(const RaysFromFilm& rays, const StopAim& aim, Vec3d film,
                                        Vec2<double> cosines) {
    constexpr int kMaxSteps = 40, kMaxHalvings = 24;
    // Rounding errors are larger through aspheres than through spheres, hence the looser limit for accepting a ray.
    const double converged = 1e-11 * rays.stop_radius(), acceptable = 1e-7 * rays.stop_radius();
    std::optional<StopAim::Probe> current = aim.probe(cosines);
    for (int step = 0; current && current->error() > converged && step < kMaxSteps; ++step) {
        const Vec2<double> change = current->slope.inverse() * current->miss;
        std::optional<StopAim::Probe> next;
        Vec2<double> next_cosines{};
        for (int halving = 0; halving <= kMaxHalvings; ++halving) {
            const double fraction = std::ldexp(1.0, -halving);
            next_cosines = {cosines.x - fraction * change.x, cosines.y - fraction * change.y};
            next = aim.probe(next_cosines);
            if (next && next->error() < current->error()) break;
            next.reset();
        }
        if (!next) break;  // converged to rounding, or stuck
        current = next;
        cosines = next_cosines;
    }
    if (!current || !(current->error() < acceptable)) return {};
    const Vec2<double> found[] = {cosines};
    LensRays<double, 1> ray = aim.from_film(found);
    const Vec3d film_direction = (-1 / rays.film_index()) * ray.direction[0];
    rays.to_scene(ray);
    if (ray.status[0] != 0) return {};
    return ChiefRay{film, film_direction, ray.origin[0], (-1 / rays.scene_index()) * ray.direction[0]};
}

}  // namespace

std::optional<ChiefRay> chief_ray_near(const RaysFromFilm& rays, Vec2<double> film, Vec2<double> cosines) {
    const Vec3d point = rays.film_point(film);
    return solve_chief_ray(rays, StopAim(rays, point), point, cosines);
}

std::optional<ChiefRay> chief_ray_of_film_point(const RaysFromFilm& rays, Vec2<double> film) {
    const Vec3d point = rays.film_point(film);
    const StopAim aim(rays, point);
    // Rays far beyond the rims may reach the stop's centre along paths that do not belong to the lens's image. Rays
    // within the rims are therefore tried first.
    for (const bool within_rims : {true, false})
        if (const std::optional<Vec2<double>> start = aim.nearest(within_rims))
            if (const std::optional<ChiefRay> found = solve_chief_ray(rays, aim, point, *start)) return found;
    return {};
}

std::optional<ChiefRay> MeridionalChiefRays::next(double film_y) {
    const Vec2<double> film{0, film_y};
    std::optional<ChiefRay> ray = chief_ray_near(rays_, film, {0, cosine_ + change_});
    if (!ray) ray = chief_ray_of_film_point(rays_, film);
    if (!ray) return std::nullopt;
    const double cosine = -rays_.film_index() * ray->film_direction.y;
    change_ = cosine - cosine_;
    cosine_ = cosine;
    return ray;
}

namespace {

/// Returns the error of a chief ray's direction relative to a field angle: its x component, and its component across
/// the direction at that angle in the y-z plane.
Vec2<double> direction_error(const ChiefRay& ray, double angle_rad) {
    const Vec3d d = ray.scene_direction;
    return {d.x, d.y * std::cos(angle_rad) - d.z * std::sin(angle_rad)};
}

/// Finds the chief ray at a field angle by Newton's method in the film point, with a Jacobian by differences. `film`:
/// the start on entry, the film point of the ray on return. Returns std::nullopt if it does not converge.
std::optional<ChiefRay> chief_ray_at_angle(const RaysFromFilm& rays, Vec2<double>& film, double angle_rad) {
    constexpr int kMaxSteps = 20;
    constexpr double kConverged = 1e-13, kAcceptable = 1e-9, kStep = 1e-5;  // rad, rad, mm
    std::optional<ChiefRay> best;
    double smallest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kMaxSteps; ++i) {
        const std::optional<ChiefRay> current = chief_ray_of_film_point(rays, film);
        const std::optional<ChiefRay> x = chief_ray_of_film_point(rays, {film.x + kStep, film.y});
        const std::optional<ChiefRay> y = chief_ray_of_film_point(rays, {film.x, film.y + kStep});
        if (!current || !x || !y) return {};
        const Vec2<double> error = direction_error(*current, angle_rad);
        const double size = hypotenuse(error.x, error.y);
        if (!(size < smallest)) return smallest < kAcceptable ? best : std::nullopt;  // converged to rounding
        best = current;
        smallest = size;
        if (size < kConverged) return best;
        const Vec2<double> at_x = direction_error(*x, angle_rad), at_y = direction_error(*y, angle_rad);
        const Matrix2 slope{{(at_x.x - error.x) / kStep, (at_y.x - error.x) / kStep},
                            {(at_x.y - error.y) / kStep, (at_y.y - error.y) / kStep}};
        const Vec2<double> change = slope.inverse() * error;
        film = {film.x - change.x, film.y - change.y};
    }
    return {};
}

}  // namespace

std::optional<ChiefRay> chief_ray_of_angle(const RaysFromFilm& rays, double angle_rad) {
    constexpr double kMaxStep_rad = 0.09;
    const int steps = std::max(1, static_cast<int>(std::ceil(std::fabs(angle_rad) / kMaxStep_rad)));
    Vec2<double> film{0, 0};
    std::optional<ChiefRay> found;
    for (int i = 1; i <= steps; ++i) {
        found = chief_ray_at_angle(rays, film, angle_rad * i / steps);
        if (!found) return {};
    }
    return found;
}

}  // namespace realcam
