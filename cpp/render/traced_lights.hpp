#pragma once
#include <vector>

#include "../camera/camera_setup.hpp"
#include "../optics/pupil/pupil_tracer.hpp"
#include "light_groups.hpp"
#include "path_settings.hpp"

namespace REALCAM_NAMESPACE {

/// Chooses the lights whose images are found from their own side (trace_lights.hpp), and how many samples each gets:
/// points and suns, which no ray meets, and emitters that fill little of the pupil. Owns the memory of its view.
class TracedLights {
public:
    TracedLights() = default;
    /// `camera`: of the set-up, with the scene's origin. The set-up has entries of its pupil.
    TracedLights(const SceneView& scene, const CameraView& camera, const CameraSetup& setup, LightTracing tracing,
                 const PupilTracer& tracer);

    bool empty() const { return lights_.empty(); }
    TracedLightsView view() const;
    /// How often samples are taken: one for so many of pixels.
    std::int32_t pixel_samples() const { return pixel_samples_; }

private:
    void add(const SceneView& scene, const LightGroup& group, TracedLight light);
    /// Which light a sample takes, by its number.
    void set_turns();

    std::vector<TracedLight> lights_;
    std::vector<std::int32_t> turns_, triangles_, light_of_area_;
    std::vector<float> cdfs_, share_of_area_;
    std::int32_t pixel_samples_ = 1;
    float scale_ = 0;
};

/// Those of a picture: none where the camera's model has no way for them. `camera`: of the set-up.
TracedLights traced_lights(const SceneView& scene, const CameraView& camera, const CameraSetup& setup,
                           LightTracing tracing, const PupilTracer& tracer);

/// The smallest share of a pixel's footprint that a lamp in view fills. Returns 1 if lamps are traced, or none is in
/// view.
double least_lamp_share(const SceneView& scene, const CameraView& camera, const CameraSetup& setup,
                        LightTracing tracing);

/// All light of a picture that is traced apart from the samples of its pixels: at most kMostSplats.
std::vector<GhostView> splatted_lights(const CameraSetup& setup, const TracedLights& lights);

}  // namespace REALCAM_NAMESPACE
