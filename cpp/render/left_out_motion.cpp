#include "left_out_motion.hpp"

namespace realcam {

std::optional<SceneAndCamera> without_left_out_motion(const Assembly& scene, const Camera& camera,
                                                      const EffectChoice& effects) {
    if (effects.motion_blur && effects.rolling_shutter) return std::nullopt;
    SceneAndCamera seen{scene, camera};
    Shutter& shutter = seen.camera.shutter;
    if (!effects.rolling_shutter) shutter.readout_time_s = 0;
    if (effects.motion_blur) return seen;
    if (shutter.readout_time_s > 0) {
        shutter.blurs = false;
        return seen;
    }
    // All rows are exposed at one instant, at which the scene stands still, so that the kernels without motion suffice.
    const double middle_s = shutter.opens_s + 0.5 * camera.exposure_time_s;
    seen.camera.pose = pose_at(camera, middle_s);
    seen.camera.motion.clear();
    seen.scene = standing_at(scene, middle_s);
    return seen;
}

}  // namespace realcam
