#pragma once
#include "../../camera/film/camera.hpp"
#include "../../optics/pupil/pupil_tracer.hpp"
#include "../../scene/assembly.hpp"

namespace realcam {

// Benchmarks of the parts of rendering on one GPU.

/// Rays per second, in the best of several rounds.
struct LensRayRates {
    double traced;  ///< through all surfaces, starting from given rays: trace_lens alone
    double generated;  ///< sampling of film and pupil, lens, and transform to the scene: generate_rays
    double passed;  ///< fraction of the generated rays that pass the lens
};

/// Measures rays over the whole film and pupil of a camera. Throws DeviceError, and InputError like CameraSetup.
LensRayRates lens_ray_rates(int ordinal, const Camera& camera, PupilTracer tracer);

/// Times and rates of ray-scene intersection, rates in the best of several rounds.
struct HitRates {
    double build_seconds;  ///< BVH construction on the host
    double upload_seconds;  ///< copying scene and BVH to the GPU
    double camera_rays;  ///< closest hits per second of camera rays
    double bounce_rays;  ///< closest hits per second of cosine-weighted rays scattered at the camera rays' hits
    double uniform_rays;  ///< closest hits per second of rays scattered there uniformly over the hemisphere
};

/// Measures closest hits in a scene: one camera ray for each pixel, unless the lens stops it, and
/// one bounce at its hit. Throws as
/// lens_ray_rates, and for an invalid scene.
HitRates hit_rates(int ordinal, const Assembly& scene, const Camera& camera, PupilTracer tracer);

}  // namespace realcam
