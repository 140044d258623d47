#pragma once
#include <cstdint>

#include "../camera/film/camera.hpp"
#include "../camera/ray_request.hpp"
#include "../optics/analysis/film_points_request.hpp"
#include "../optics/analysis/point_bundle.hpp"
#include "../optics/analysis/trace_path.hpp"
#include "../optics/pupil/pupil_tracer.hpp"
#include "../optics/trace/ray_loop.hpp"
#include "kernels.hpp"

// Rays through lenses and from cameras on the CPU, in vector code and on all cores.

namespace realcam {

/// Returns a lens tracer for Pupil that uses the machine's vector instructions and its cores (those of the calling
/// thread's TBB arena).
PupilTracer fast_pupil_tracer();

class CameraSetup;

/// Traces rays through a lens on all cores. Origins in mm and directions (of any length) in the lens frame, count x 3.
/// Rays with a component that is not finite, a direction of length zero or an origin beyond kFarthestOrigin end as
/// bad_input with zeros. A ray from far away that hits no surface ends where it is nearest to the first vertex. Only
/// the first `surface_count` surfaces along the light's path are traced (all if it is negative). `on`: kernels of one
/// instruction set; nullptr: the machine's best. Throws Cancelled.
void trace_rays(const LensSystem& lens, LightDirection direction, double wavelength_nm, Precision precision,
                int surface_count, std::int64_t count, const double* origins, const double* directions,
                const TracedRays& out, const realcam_kernels* on = nullptr, const KeepGoing& keep_going = {});

/// Traces `count` rays of one object point, whose entry points lie over the bundle's entrance-pupil bounds in a
/// pattern, on the calling thread. Writes x and y on the film, mm from the axis, of the rays that pass the lens to
/// `at`, an array of 2 x count numbers, and returns the number of these rays. `film_distance`: from the last vertex,
/// mm. Throws Cancelled.
std::int64_t find_film_points(const LensSystem& lens, double wavelength_nm, const PointBundle& bundle,
                              EntryPattern pattern, Precision precision, std::int64_t count, double film_distance,
                              float* at, const KeepGoing& keep_going = {});

/// Returns a loop over rays on all cores. `grain`: number of rays that one task traces. Throws Cancelled from the loop
/// if `keep_going` returns false.
RayLoop parallel_ray_loop(KeepGoing keep_going, std::size_t grain = 64);

/// Output arrays for a camera's rays.
struct CameraRayOutput {
    double* origins_m;  ///< 3 per ray, scene frame
    float* directions;  ///< 3 per ray, unit vectors in the scene frame
    float* weights;  ///< irradiance on the film for unit radiance; 0 if the ray does not leave the lens
    float* wavelengths_nm;  ///< wavelength of each ray
    double* times_s;  ///< time of each ray

    /// Returns the arrays from a ray on.
    CameraRayOutput from(std::int64_t ray) const {
        return {origins_m + 3 * ray, directions + 3 * ray, weights + ray, wavelengths_nm + ray, times_s + ray};
    }
};

/// Generates a range of the camera's rays: `spp` per pixel, pixel by pixel in rows. `seed`: of the random numbers.
void generate_camera_rays(const CameraSetup& setup, std::uint32_t spp, std::uint32_t seed, RayRange range,
                          const CameraRayOutput& out);

}  // namespace realcam
