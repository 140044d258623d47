#pragma once
#include <vector>

#include "../../camera/camera_setup.hpp"
#include "../../optics/pupil/pupil_tracer.hpp"
#include "../path/path_settings.hpp"
#include "light_groups.hpp"

namespace REALCAM_NAMESPACE {

/// Lights whose images are found by light tracing (trace_lights.hpp), with their sampling probabilities: point lights
/// and suns, which no ray hits, and emitters that fill little of a pixel's footprint (light_groups). Owns the memory of
/// its view.
class TracedLights {
public:
    TracedLights() = default;
    /// Chooses the lights. `camera`: view of the set-up's camera in the render space of `scene`; `setup`: must have
    /// traces_lights(); `tracing`: not LightTracing::off. `tracer`: traces the rays that search for entrance-pupil
    /// bounds.
    TracedLights(const SceneView& scene, const CameraView& camera, const CameraSetup& setup, LightTracing tracing,
                 const PupilTracer& tracer);

    /// True if no light is traced.
    bool empty() const { return lights_.empty(); }
    TracedLightsView view() const;
    /// Number of pixel samples (of all pixels together) for each sample from the lights.
    std::int32_t pixel_samples() const { return pixel_samples_; }

private:
    /// Appends a light, with its triangles and their probabilities.
    void add(const SceneView& scene, const LightGroup& group, TracedLight light);
    /// Fills turns_, which maps the last bits of a sample's index to its light.
    void set_turns();

    // Arrays and scale of TracedLightsView:
    std::vector<TracedLight> lights_;
    std::vector<std::int32_t> turns_, triangles_, light_of_area_;
    std::vector<float> cdfs_, share_of_area_;
    std::int32_t pixel_samples_ = 1;
    float scale_ = 0;
};

/// Returns the traced lights of a picture; empty if `tracing` is off, or the camera model has no lens to trace.
/// `camera`: view of the set-up's camera in the render space of `scene`.
TracedLights traced_lights(const SceneView& scene, const CameraView& camera, const CameraSetup& setup,
                           LightTracing tracing, const PupilTracer& tracer);

/// Returns the smallest fraction of a pixel's footprint (light_groups) that a lamp in view fills: the probability that
/// a sample of such a pixel hits the lamp. Returns 1 if lamps are found by light tracing, or no lamp is in view.
double least_lamp_share(const SceneView& scene, const CameraView& camera, const CameraSetup& setup,
                        LightTracing tracing);

/// Returns a view for each kind of splatted light of a picture, at most kMaxGhostViews: ghosts and starbursts of the
/// set-up, and the images of `lights`.
std::vector<GhostView> splatted_lights(const CameraSetup& setup, const TracedLights& lights);

}  // namespace REALCAM_NAMESPACE
