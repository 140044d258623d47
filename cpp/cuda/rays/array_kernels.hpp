#pragma once
#include <cuda_runtime.h>

#include <cstdint>

#include "../../camera/ray_request.hpp"
#include "../../math/motion.hpp"

namespace realcam {

/// Converts float32 to float64. All arrays of this file are in the current device's memory; functions throw DeviceError
/// if a kernel cannot be launched.
void launch_widen(const float* from, std::int64_t count, double* to, cudaStream_t stream);

/// Converts rays whose origins are relative to the camera, spp for each pixel, starting at ray `range.first`: writes
/// origins in scene space, times and pixel indices. The camera position is added in double, as on the CPU: far from the
/// scene's origin float would not resolve the pupil.
struct RaysToScene {
    const float* relative;  ///< range.count x 3, m
    const float* shares;  ///< range.count; times as fractions of the exposure
    Vec3d camera_position;
    TimeInterval exposure;
    RayRange range;
    std::uint32_t spp;
    double* origins;  ///< range.count x 3, m
    double* times;  ///< range.count, s
    int* pixels;
};
void launch_rays_to_scene(const RaysToScene& rays, cudaStream_t stream);

}  // namespace realcam
