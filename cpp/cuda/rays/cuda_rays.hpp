#pragma once
#include "../../camera/film/camera.hpp"
#include "../../camera/ray_request.hpp"
#include "../../optics/analysis/trace_path.hpp"

namespace realcam {

class CameraSetup;

/// Traces rays through a lens on the GPU `ordinal`, like trace_rays on the CPU (embree/lens_rays.hpp), with all arrays
/// in that GPU's memory. Synchronous. Throws InputError and DeviceError.
void trace_rays_on_device(int ordinal, const LensSystem& lens, LightDirection direction, double wavelength_nm,
                          Precision precision, int surface_count, std::int64_t count, const double* origins,
                          const double* directions, const TracedRays& out);

/// Like trace_rays_on_device, with arrays in host memory, which are copied to the GPU and back.
void trace_rays_on_gpu(int ordinal, const LensSystem& lens, LightDirection direction, double wavelength_nm,
                       Precision precision, int surface_count, std::int64_t count, const double* origins,
                       const double* directions, const TracedRays& out);

/// Output arrays of generate_camera_rays_on_device in the GPU's memory, laid out like those of RayRequest.
struct DeviceRayOutput {
    float *origins, *directions, *weights, *times, *wavelengths_nm;
};

/// Generates camera rays like generate_camera_rays on the CPU (embree/lens_rays.hpp), except that origins are floats
/// relative to the camera's position and times are fractions of its exposure. Synchronous.
void generate_camera_rays_on_device(int ordinal, const CameraSetup& setup, std::uint32_t spp, std::uint32_t seed,
                                    RayRange range, const DeviceRayOutput& out);

}  // namespace realcam
