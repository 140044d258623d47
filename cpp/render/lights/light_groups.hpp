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
    /// For area lights: fraction of a pixel's footprint that these and neighbouring emitters fill.
    double filled_fraction = 0;
};

/// Returns the lights whose images are worth light tracing: all point lights and suns, and the emissive triangles that
/// fill little of a pixel's footprint at their distance, because they are out of focus or smaller than the pixel. The
/// footprint is the region that the samples of one pixel cover. Triangles near each other, such as those of one lamp,
/// form one group.
std::vector<LightGroup> light_groups(const SceneView& scene, const CameraView& camera);

}  // namespace REALCAM_NAMESPACE
