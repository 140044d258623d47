#include "scene_bundle.hpp"

#include <limits>

namespace realcam {

Vec2<double> SceneBundle::landing(Entry entry) const {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    const Entry entries[1] = {entry};
    LensRays<double, 1> ray;
    trace(entries, ray);
    if (ray.status[0] != 0) return {kNone, kNone};
    return film_.landing(ray.origin[0], ray.direction[0]);
}

}  // namespace realcam
