#pragma once
#include <vector>

#include "../../camera/effects/traced_lights_view.hpp"
#include "../../camera/models/camera_view.hpp"
#include "../../scene/scene_view.hpp"

namespace REALCAM_NAMESPACE {

/// Lights that are traced together: one point or sun, or area lights of the scene.
struct LightGroup {
    TracedLightKind kind;
    std::vector<std::int32_t> lights;  ///< indices among the lights of their kind
    /// For area lights: fraction of a pixel's footprint that these and similar lights fill.
    double share = 0;
};

/// All points and suns, and the emitters that fill little of a pixel's footprint at their distance, because they are
/// out of focus or smaller than the pixel. Emitters near each other, such as those of one lamp, form one group.
std::vector<LightGroup> light_groups(const SceneView& scene, const CameraView& camera);

}  // namespace REALCAM_NAMESPACE
