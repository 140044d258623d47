#include "cuda_rays.hpp"

#include "../../camera/camera_setup.hpp"
#include "../device/cuda_stream.hpp"
#include "../device/current_device.hpp"
#include "../device/device_array.hpp"
#include "ray_kernels.hpp"

namespace realcam {
namespace {

/// Traces rays in the precision T; the arrays are in the GPU's memory.
template <class T>
void trace_with(int ordinal, const TracePath<T>& path, std::int64_t count, const double* origins,
                const double* directions, const TracedRays& out) {
    const CurrentDevice current(ordinal);
    const CudaStream stream;
    DeviceArrays arrays;
    TraceRequest<T> request = path.request(count, origins, directions, out);
    request.lens.surfaces = arrays.copy(request.lens.surfaces, static_cast<std::size_t>(request.lens.count), stream);
    request.lens.free.move_arrays(request.lens.count, [&](auto*& array, int surfaces) {
        if (array) array = arrays.copy(array, static_cast<std::size_t>(surfaces), stream);
    });
    launch_trace(request, stream);
    stream.wait("tracing rays");
}

}  // namespace

void trace_rays_on_device(int ordinal, const LensSystem& lens, LightDirection direction, double wavelength_nm,
                          Precision precision, int surface_count, std::int64_t count, const double* origins,
                          const double* directions, const TracedRays& out) {
    if (precision == Precision::float64)
        trace_with(ordinal, TracePath<double>(lens, direction, wavelength_nm, surface_count), count, origins,
                   directions, out);
    else
        trace_with(ordinal, TracePath<float>(lens, direction, wavelength_nm, surface_count), count, origins, directions,
                   out);
}

void trace_rays_on_gpu(int ordinal, const LensSystem& lens, LightDirection direction, double wavelength_nm,
                       Precision precision, int surface_count, std::int64_t count, const double* origins,
                       const double* directions, const TracedRays& out) {
    const CurrentDevice current(ordinal);
    const CudaStream stream;
    const auto rays = static_cast<std::size_t>(count);
    DeviceArray<double> from, along, to, towards, path;
    DeviceArray<int> status, surface;
    from.upload(origins, 3 * rays, stream);
    along.upload(directions, 3 * rays, stream);
    to.resize(3 * rays);
    towards.resize(3 * rays);
    path.resize(rays);
    status.resize(rays);
    surface.resize(rays);
    stream.wait("copying rays to it");
    trace_rays_on_device(ordinal, lens, direction, wavelength_nm, precision, surface_count, count, from.data(),
                         along.data(), {to.data(), towards.data(), path.data(), status.data(), surface.data()});
    to.download(out.origins, stream);
    towards.download(out.directions, stream);
    path.download(out.optical_path, stream);
    status.download(out.status, stream);
    surface.download(out.surface_index, stream);
    stream.wait("copying rays from it");
}

void generate_camera_rays_on_device(int ordinal, const CameraSetup& setup, std::uint32_t spp, std::uint32_t seed,
                                    RayRange range, const DeviceRayOutput& out) {
    const CurrentDevice current(ordinal);
    const CudaStream stream;
    DeviceArrays arrays;
    const CameraView view =
        with_copied_arrays(setup.view(setup.camera().pose.position_m, true),
                           [&](const auto* from, std::size_t count) { return arrays.copy(from, count, stream); });
    const auto design_nm = static_cast<float>(setup.camera().lens.wavelength_nm);
    launch_generate(
        {view, range, spp, seed, out.origins, out.directions, out.weights, out.times, out.wavelengths_nm, design_nm},
        stream);
    stream.wait("generating rays");
}

}  // namespace realcam
