#include "film_chief_ray.hpp"

#include <cmath>

namespace realcam {

FilmChiefRay::FilmChiefRay(const LensSystem& lens)
    : path_(lens, LightDirection::to_scene, lens.wavelength_nm),
      open_(AimingPath::open(path_)),
      film_distance_(lens.film_distance),
      to_stop_(static_cast<int>(lens.surfaces.size()) - lens.stop_index()),
      close_(1e-11 * lens.stop().clear_semi_diameter) {}

std::optional<SceneRay> FilmChiefRay::operator()(double film_radius, double& cosine) const {
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

std::optional<SceneRay> FilmChiefRay::leaving(double film_radius, double cosine) const {
    const double cosines[1] = {cosine};
    const LensRays<double, 1> ray = trace(film_radius, cosines, open_.view().count);
    if (ray.status[0] != 0) return {};
    return SceneRay{ray.origin[0], ray.direction[0]};
}

}  // namespace realcam
