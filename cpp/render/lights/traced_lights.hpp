#pragma once
#include <vector>

#include "../../camera/camera_setup.hpp"
#include "../../optics/pupil/pupil_tracer.hpp"
#include "../path/path_settings.hpp"
#include "light_groups.hpp"

namespace REALCAM_NAMESPACE {

/// Chooses the lights whose images are found by light tracing (trace_lights.hpp), and the number of samples of each:
/// points and suns, which no ray hits, and emitters that fill little of a pixel's footprint. Owns the memory of its
/// view.
class TracedLights {
public:
    TracedLights() = default;
    /// `camera`: that of the set-up, with the scene's origin. The set-up has entries of its pupil.
    TracedLights(const SceneView& scene, const CameraView& camera, const CameraSetup& setup, LightTracing tracing,
                 const PupilTracer& tracer);

    bool empty() const { return lights_.empty(); }
    TracedLightsView view() const;
    /// Number of pixel samples for each sample from the lights.
    std::int32_t pixel_samples() const { return pixel_samples_; }

private:
    void add(const SceneView& scene, const LightGroup& group, TracedLight light);
    /// Sets the light of each sample, by the sample's index.
    void set_turns();

    std::vector<TracedLight> lights_;
    std::vector<std::int32_t> turns_, triangles_, light_of_area_;
    std::vector<float> cdfs_, share_of_area_;
    std::int32_t pixel_samples_ = 1;
    float scale_ = 0;
};

/// Traced lights of a picture; empty if the camera's model has no light path for them. `camera`: that of the set-up.
TracedLights traced_lights(const SceneView& scene, const CameraView& camera, const CameraSetup& setup,
                           LightTracing tracing, const PupilTracer& tracer);

/// Smallest fraction of a pixel's footprint that a lamp in view fills. Returns 1 if lamps are traced, or no lamp is in
/// view.
double least_lamp_share(const SceneView& scene, const CameraView& camera, const CameraSetup& setup,
                        LightTracing tracing);

/// All films of light that is traced apart from the samples of the pixels: at most kMostSplats.
std::vector<GhostView> splatted_lights(const CameraSetup& setup, const TracedLights& lights);

}  // namespace REALCAM_NAMESPACE
