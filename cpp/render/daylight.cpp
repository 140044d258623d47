#include "daylight.hpp"

namespace realcam {

void add_daylight(Scene& scene, const Pose& pose) {
    const auto axes = camera_detail::axes_of(pose);
    const Vec3d to_sun = normalized(-0.5 * axes.right + 0.8 * axes.up + 0.6 * axes.backward);
    scene.suns.push_back({static_cast<Vec3f>(-to_sun), {84e3f, 80e3f, 68e3f}});
    scene.environment = {};
    scene.environment.constant = {4450, 5040, 6250};
}

}  // namespace realcam
