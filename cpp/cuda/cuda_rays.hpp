#pragma once
#include "../camera/camera.hpp"
#include "../camera/ray_request.hpp"
#include "../optics/analysis/trace_path.hpp"

namespace realcam {

class CameraSetup;

/// Traces rays through a lens on a GPU: as trace_rays of the CPU, with arrays in that GPU's memory. Returns when they
/// are traced. Throws InputError and DeviceError.
void trace_rays_on_device(int ordinal, const LensSystem& lens, LightDirection direction, double wavelength_nm,
                          Precision precision, int surface_count, std::int64_t count, const double* origins,
                          const double* directions, const TracedRays& out);

/// The same with arrays of the host, which are copied there and back.
void trace_rays_on_gpu(int ordinal, const LensSystem& lens, LightDirection direction, double wavelength_nm,
                       Precision precision, int surface_count, std::int64_t count, const double* origins,
                       const double* directions, const TracedRays& out);

/// Where a camera's rays are written in the GPU's memory: as RayRequest.
struct DeviceRayOutput {
    float *origins, *directions, *weights, *times, *wavelengths_nm;
};

/// Some of the camera's own rays, as generate_camera_rays of the CPU. But the origins are floats, relative to the
/// camera's position, and times shares of its exposure. Returns when they are made.
void generate_camera_rays_on_device(int ordinal, const CameraSetup& setup, std::uint32_t spp, std::uint32_t seed,
                                    RayRange range, const DeviceRayOutput& out);

}  // namespace realcam
