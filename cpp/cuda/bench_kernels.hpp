#pragma once
#include "../camera/camera.hpp"
#include "../optics/pupil/pupil_tracer.hpp"
#include "../scene/assembly.hpp"

namespace realcam {

/// Rays per second on one GPU, in the best of several rounds.
struct LensRayRates {
    double traced;     ///< through every surface, from rays at hand: trace_lens alone
    double generated;  ///< film point, pupil point, lens, and into the scene: generate_rays
    double passed;     ///< share of the generated ones that pass
};

/// Rays all over the camera's film and pupil. Throws DeviceError, and InputError as CameraSetup.
LensRayRates lens_ray_rates(int ordinal, const Camera& camera, PupilTracer tracer);

struct HitRates {
    double build_seconds;  ///< of the hierarchy, on the host
    double upload_seconds;
    double camera_rays;    ///< closest hits of rays from the camera
    double bounce_rays;    ///< closest hits of rays that leave those hits by the cosine
    double uniform_rays;   ///< likewise, but evenly over the hemisphere
};

/// Closest hits in a scene as the camera sees it: one ray for each pixel, and one bounce from where it meets something.
HitRates hit_rates(int ordinal, const Assembly& scene, const Camera& camera, PupilTracer tracer);

}  // namespace realcam
