#pragma once
#include "../../camera/film/camera.hpp"
#include "../../camera/ray_request.hpp"
#include "../../optics/analysis/trace_path.hpp"
#include "../device/shared_device_array.hpp"

namespace realcam {

class CameraSetup;

/// Array in a GPU's memory that another library owns: float32 or float64, in C order.
struct ForeignNumbers {
    const void* data;
    int ordinal;  ///< ordinal of the GPU
    NumberType type;
};

/// Results of traced rays as TracedRays, in owned arrays of a GPU.
struct TracedArrays {
    SharedDeviceArray origins, directions, optical_path;  ///< float64
    SharedDeviceArray status, surface_index;  ///< int32
};

/// Traces rays through a lens like trace_rays_on_device, and returns the results in new arrays. `origins` and
/// `directions` have count x 3 numbers and lie on the same GPU, which traces them. Throws InputError and DeviceError.
TracedArrays trace_arrays(const LensSystem& lens, LightDirection direction, double wavelength_nm, Precision precision,
                          int surface_count, std::int64_t count, ForeignNumbers origins, ForeignNumbers directions);

/// Camera rays like those of generate_camera_rays on the CPU, in owned arrays of a GPU.
struct CameraRayArrays {
    SharedDeviceArray origins_m, directions, weights, wavelengths_nm, times_s;
    SharedDeviceArray pixels;  ///< pixel of each ray: row * width + column
};

/// Generates camera rays on a GPU. Throws InputError and DeviceError.
CameraRayArrays generate_ray_arrays(int ordinal, const CameraSetup& setup, std::uint32_t spp, std::uint32_t seed,
                                    RayRange range);

}  // namespace realcam
