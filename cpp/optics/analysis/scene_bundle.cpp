#include "scene_bundle.hpp"

#include <limits>

namespace realcam {

SceneBundle::SceneBundle(const LensPath<double>& path, double film_distance, const SceneRay& ray, double distance,
                         Entry middle, Entry reach)
    : middle(middle),
      reach(reach),
      view_(path.view()),
      index_(path.entry_index),
      film_distance_(film_distance),
      ray_(ray),
      inverse_distance_(1 / distance) {}

double SceneBundle::film_height(Entry entry) const {
    const Entry entries[1] = {entry};
    LensRays<double, 1> ray;
    trace(entries, ray);
    if (ray.status[0] != 0) return std::numeric_limits<double>::quiet_NaN();
    return crossing_at(film_distance_, ray.origin[0], ray.direction[0]).x;
}

}  // namespace realcam
