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
    explicit FilmChiefRay(const LensSystem& lens);

    /// `cosine`: optical direction cosine along the film's radius at which the search begins, and which it leaves at
    /// that of the ray found. Nothing where it finds none.
    std::optional<SceneRay> operator()(double film_radius, double& cosine) const;

private:
    std::optional<SceneRay> leaving(double film_radius, double cosine) const;

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
