#pragma once
#include <optional>

#include "ray_aiming.hpp"

namespace REALCAM_NAMESPACE {

/// A ray in front of the lens, relative to its front vertex.
struct SceneRay {
    Vec3d origin, direction;
};

/// Finds the rays from film points on the +x axis through the middle of the stop, whether or not a rim or an
/// obstruction blocks them.
class FilmChiefRay {
public:
    explicit FilmChiefRay(const LensSystem& lens)
        : path_(lens, LightDirection::to_scene, lens.wavelength_nm),
          open_(AimingPath::open(path_)),
          film_distance_(lens.film_distance),
          to_stop_(static_cast<int>(lens.surfaces.size()) - lens.stop_index()),
          close_(1e-11 * lens.stop().clear_semi_diameter) {}

    /// `cosine`: optical direction cosine along the film's radius at which the search begins, and which it leaves at
    /// that of the ray found. Nothing where it finds none.
    std::optional<SceneRay> operator()(double film_radius, double& cosine) const {
        constexpr int kMost = 40;
        constexpr double kStep = 1e-6;
        double l = cosine;
        for (int i = 0; i < kMost; ++i) {
            const double cosines[2] = {l, l + kStep};
            const LensRays<double, 2> rays = trace(film_radius, cosines, to_stop_);
            if (rays.status[0] != 0 || rays.status[1] != 0) return {};
            const double miss = rays.origin.x[0], slope = (rays.origin.x[1] - miss) / kStep;
            if (std::fabs(miss) <= close_) {
                cosine = l;
                return leaving(film_radius, l);
            }
            l -= miss / slope;
        }
        return {};
    }

private:
    std::optional<SceneRay> leaving(double film_radius, double cosine) const {
        const double cosines[1] = {cosine};
        const LensRays<double, 1> ray = trace(film_radius, cosines, open_.view().count);
        if (ray.status[0] != 0) return {};
        return SceneRay{ray.origin[0], ray.direction[0]};
    }

    template <int N>
    LensRays<double, N> trace(double film_radius, const double (&cosines)[N], int surfaces) const {
        LensView<double> view = open_.view();
        view.count = surfaces;
        LensRays<double, N> rays;
        for (int i = 0; i < N; ++i) {
            const double rest = path_.entry_index * path_.entry_index - cosines[i] * cosines[i];
            rays.origin.set(i, {film_radius, 0, film_distance_});
            rays.direction.set(i, {cosines[i], 0, -sqrt_or_zero(rest)});
            rays.status[i] = rest > 0 ? 0 : static_cast<int>(RayStatus::missed);
        }
        trace_lens(view, rays);
        return rays;
    }

    LensPath<double> path_;
    AimingPath open_;
    double film_distance_;
    int to_stop_;
    double close_;  ///< to the middle of the stop, mm
};

}  // namespace REALCAM_NAMESPACE
