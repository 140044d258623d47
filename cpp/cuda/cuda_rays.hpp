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

/// Some of the camera's own rays into arrays of the GPU's memory, as generate_camera_rays of the CPU, but for the
/// origins: they are floats, relative to the camera's position. Returns when they are made.
void generate_camera_rays_on_device(int ordinal, const CameraSetup& setup, std::uint32_t spp, std::uint32_t seed,
                                    RayRange range, float* origins, float* directions, float* weights);

}  // namespace realcam
