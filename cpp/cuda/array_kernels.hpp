#pragma once
#include <cuda_runtime.h>

#include <cstdint>

#include "../camera/ray_request.hpp"
#include "../math/motion.hpp"

namespace realcam {

/// float32 as float64. Arrays here lie on the current device; all throw DeviceError where they cannot be started.
void launch_widen(const float* from, std::int64_t count, double* to, cudaStream_t stream);

/// Converts rays with origins relative to the camera, spp for each pixel, from the ray `first` on. It writes their
/// origins in the scene, their times, and their pixels. The camera's place is added in double, as on the CPU: far from
/// the scene's origin float would lose the pupil.
struct PlaceRays {
    const float* relative;  ///< range.count x 3, m
    const float* shares;    ///< range.count, of the exposure
    Vec3d place;
    TimeInterval exposure;
    RayRange range;
    std::uint32_t spp;
    double* origins;  ///< range.count x 3, m
    double* times;    ///< range.count, s
    int* pixels;
};
void launch_place(const PlaceRays& rays, cudaStream_t stream);

}  // namespace realcam
