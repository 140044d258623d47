#include "chief_ray.hpp"

#include <algorithm>
#include <cmath>

#include "../../math/hypotenuse.hpp"
#include "../../math/matrix2.hpp"
#include "../prescription/surface_frames.hpp"
#include "../pupil/film_surface.hpp"

namespace realcam {

FilmRays::FilmRays(const LensSystem& lens, double wavelength_nm)
    : ends_(film_path_ends(lens, LightDirection::to_scene)),
      path_(lens, LightDirection::to_scene, wavelength_nm, ends_),
      open_(AimingPath::open(path_)),
      last_rim_(lens.surfaces.back().clear_semi_diameter),
      film_distance_(lens.film_distance),
      film_curvature_(1 / lens.film_radius_of_curvature),
      scene_index_(lens.indices(wavelength_nm).front()),
      stop_radius_(std::min(lens.stop_semi_diameter, lens.stop().clear_semi_diameter)),
      to_stop_(static_cast<int>(lens.surfaces.size()) - lens.stop_index()) {
    if (ends_.entry) last_surface_ = inverse_motion(*ends_.entry) * surface_frames(lens).surfaces.back();
}

Vec3d FilmRays::film_point(Vec2<double> film) const {
    return FilmSurface<double>{film_distance_, film_curvature_}.place(film);
}

Vec3d FilmRays::on_last_surface(Vec2<double> share) const {
    return last_surface_.point({last_rim_ * share.x, last_rim_ * share.y, 0});
}

namespace {

/// Directions, as optical cosines l and m, from one film point to the stop.
class StopAim {
public:
    StopAim(const FilmRays& rays, Vec3d film) : rays_(rays), film_(film) {}

    template <int N>
    LensRays<double, N> from_film(const Vec2<double> (&cosines)[N]) const {
        const double n = rays_.film_index();
        LensRays<double, N> rays;
        for (int i = 0; i < N; ++i) {
            const auto [l, m] = cosines[i];
            const double rest = n * n - l * l - m * m;
            rays.origin.set(i, film_);
            rays.direction.set(i, {l, m, -sqrt_or_zero(rest)});
            rays.status[i] = rest > 0 ? 0 : static_cast<int>(RayStatus::missed);
        }
        return rays;
    }

    struct Probe {
        Vec2<double> miss;  ///< place on the stop, mm
        Matrix2 slope;      ///< its derivative by the cosines

        double error() const { return hypotenuse(miss.x, miss.y); }
    };

    std::optional<Probe> probe(Vec2<double> at) const {
        constexpr double kStep = 1e-6;
        const Vec2<double> cosines[] = {at, {at.x + kStep, at.y}, {at.x, at.y + kStep}};
        LensRays<double, 3> rays = from_film(cosines);
        rays_.to_stop(rays);
        for (const int status : rays.status)
            if (status != 0) return {};
        const auto& p = rays.origin;
        return Probe{{p.x[0], p.y[0]},
                     {{(p.x[1] - p.x[0]) / kStep, (p.x[2] - p.x[0]) / kStep},
                      {(p.y[1] - p.y[0]) / kStep, (p.y[2] - p.y[0]) / kStep}}};
    }

    /// The direction, of those to places all over the last surface, whose ray comes nearest to the stop's middle.
    std::optional<Vec2<double>> nearest() const {
        constexpr int kAcross = 15, kRays = kAcross * kAcross;
        Vec2<double> cosines[kRays];
        for (int i = 0; i < kRays; ++i) {
            const auto share = [](int step) { return 2.0 * step / (kAcross - 1) - 1; };
            const Vec3d to = rays_.on_last_surface({share(i % kAcross), share(i / kAcross)});
            const Vec3d way = rays_.film_index() * normalized(to - film_);
            cosines[i] = {way.x, way.y};
        }
        LensRays<double, kRays> rays = from_film(cosines);
        rays_.to_stop(rays);
        std::optional<Vec2<double>> best;
        double least = std::numeric_limits<double>::infinity();
        for (int i = 0; i < kRays; ++i) {
            const double miss = hypotenuse(rays.origin.x[i], rays.origin.y[i]);
            if (rays.status[i] != 0 || !(miss < least)) continue;
            least = miss;
            best = cosines[i];
        }
        return best;
    }

private:
    const FilmRays& rays_;
    Vec3d film_;
};

}  // namespace

std::optional<ChiefRay> chief_ray_of_film_point(const FilmRays& rays, Vec2<double> film) {
    constexpr int kMostSteps = 40, kMostHalvings = 24;
    const double close = 1e-11 * rays.stop_radius();
    const Vec3d from = rays.film_point(film);
    const StopAim aim(rays, from);
    std::optional<Vec2<double>> at = aim.nearest();
    if (!at) return {};
    std::optional<StopAim::Probe> here = aim.probe(*at);
    for (int step = 0; here && here->error() > close; ++step) {
        if (step == kMostSteps) return {};
        const Vec2<double> change = here->slope.inverse() * here->miss;
        std::optional<StopAim::Probe> next;
        Vec2<double> there{};
        for (int halving = 0; halving <= kMostHalvings; ++halving) {
            const double share = std::ldexp(1.0, -halving);
            there = {at->x - share * change.x, at->y - share * change.y};
            next = aim.probe(there);
            if (next && next->error() < here->error()) break;
            next.reset();
        }
        if (!next && here->error() < 100 * close) break;  // as near as rounding lets it come
        here = next;
        at = there;
    }
    if (!here) return {};
    const Vec2<double> found[] = {*at};
    LensRays<double, 1> ray = aim.from_film(found);
    const Vec3d film_direction = (-1 / rays.film_index()) * ray.direction[0];
    rays.to_scene(ray);
    if (ray.status[0] != 0) return {};
    return ChiefRay{from, film_direction, ray.origin[0], (-1 / rays.scene_index()) * ray.direction[0]};
}

}  // namespace realcam
