#pragma once
#include <vector>

#include "../camera/camera_view.hpp"
#include "../camera/traced_lights_view.hpp"
#include "../scene/scene_view.hpp"

namespace REALCAM_NAMESPACE {

/// Lights that are traced together: one point or sun, or area lights of the scene.
struct LightGroup {
    TracedLightKind kind;
    std::vector<std::int32_t> lights;  ///< numbers among those of their kind
    /// Of area lights: the share of what the samples of a pixel see there that these and others like them fill.
    double share = 0;
};

/// All points and suns, and those emitters that fill little of the region which the samples of a pixel see at their
/// distance, because they are out of focus or smaller than the pixel. Emitters near each other, as those of a lamp, are
/// together.
std::vector<LightGroup> light_groups(const SceneView& scene, const CameraView& camera);

}  // namespace REALCAM_NAMESPACE
