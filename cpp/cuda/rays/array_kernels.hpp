#pragma once
#include <cuda_runtime.h>

#include <cstdint>

#include "../../camera/ray_request.hpp"
#include "../../math/motion.hpp"

namespace realcam {

// Conversions of arrays in the current device's memory. Asynchronous. Functions throw DeviceError if a kernel cannot be
// launched.

/// Converts `count` numbers from float32 to float64.
void launch_widen(const float* from, std::int64_t count, double* to, cudaStream_t stream);

/// Conversion of camera rays (`spp` per pixel) from origins relative to the camera's position and times as fractions of
/// the exposure to origins in the scene frame, times in seconds and pixel indices. The position is added in double, as
/// on the CPU: far from the scene's origin, float would not resolve the pupil.
struct RaysToScene {
    const float* relative;  ///< range.count x 3, m
    const float* shares;  ///< range.count; times as fractions of the exposure
    Vec3d camera_position;  ///< in the scene frame, m
    TimeInterval exposure;
    RayRange range;  ///< indices of the rays
    std::uint32_t spp;
    double* origins;  ///< range.count x 3, m
    double* times;  ///< range.count, s
    int* pixels;  ///< range.count; row * width + column
};

/// Launches the conversion.
void launch_rays_to_scene(const RaysToScene& rays, cudaStream_t stream);

}  // namespace realcam
