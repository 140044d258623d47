// Implements the functions of the CUDA backend in builds without it: forwards them to the plug-in, if there is one.
#include <cstdlib>
#include <utility>

#include "../cuda/cuda_backend.hpp"
#include "cuda_plugin.hpp"

#if defined(REALCAM_HAS_CUDA)

namespace realcam {

void set_cuda_plugin_path(const std::string&) {}
std::string plugin_failure() {
    return "";
}

}  // namespace realcam

#else

namespace realcam {
namespace {

/// The plug-in, or why there is none.
struct Plugin {
    const CudaBackend* backend = nullptr;
    bool is_named = false;  ///< true if a path was set
    std::string failure;    ///< message of the DeviceError, if `backend` is null
};

/// Path that set_cuda_plugin_path has set.
std::string& named_path() {
    static std::string path;
    return path;
}

/// Loads the plug-in.
Plugin load() {
    const char* const variable = std::getenv("REALCAM_CUDA_PLUGIN");
    const std::string path = variable ? variable : named_path();
    if (path.empty())
        return {
            nullptr, false,
            "this build of realcam has no CUDA backend: `pip install realcam[cuda]` adds it to the wheel, and a build "
            "from the source with nvcc has it; or use device=\"cpu\""};
    try {
        return {&load_cuda_plugin(path), true, ""};
    } catch (const DeviceError& error) {
        return {nullptr, true, error.what()};
    }
}

/// Returns the plug-in, which is loaded by the first call.
const Plugin& plugin() {
    static const Plugin loaded_once = load();
    return loaded_once;
}

/// Returns the functions of the plug-in. Throws DeviceError if there is no plug-in or it cannot be loaded.
const CudaBackend& backend() {
    if (!plugin().backend) throw DeviceError(plugin().failure);
    return *plugin().backend;
}

}  // namespace

void set_cuda_plugin_path(const std::string& path) {
    named_path() = path;
}
std::string plugin_failure() {
    return plugin().is_named ? why_no_cuda_device() : "";
}

// The functions of CudaBackend, declared in the headers of cpp/cuda.

std::vector<CudaDevice> cuda_devices() {
    return plugin().backend ? plugin().backend->cuda_devices() : std::vector<CudaDevice>{};
}
std::string why_no_cuda_device() {
    return plugin().backend ? plugin().backend->why_no_cuda_device() : plugin().failure;
}
CudaDevice cuda_device(int ordinal) {
    return backend().cuda_device(ordinal);
}
std::unique_ptr<Session> make_cuda_session(const std::vector<int>& ordinals, PupilTracer tracer) {
    return backend().make_cuda_session(ordinals, std::move(tracer));
}
std::unique_ptr<CameraGradient> make_cuda_gradient(int ordinal, const Assembly& scene, const Camera& camera,
                                                   const RenderSettings& settings, std::vector<LensVariable> variables,
                                                   const PupilTracer& tracer) {
    return backend().make_cuda_gradient(ordinal, scene, camera, settings, std::move(variables), tracer);
}
void trace_rays_on_gpu(int ordinal, const LensSystem& lens, LightDirection direction, double wavelength_nm,
                       Precision precision, int surface_count, std::int64_t count, const double* origins,
                       const double* directions, const TracedRays& out) {
    backend().trace_rays_on_gpu(ordinal, lens, direction, wavelength_nm, precision, surface_count, count, origins,
                                directions, out);
}
TracedArrays trace_arrays(const LensSystem& lens, LightDirection direction, double wavelength_nm, Precision precision,
                          int surface_count, std::int64_t count, ForeignNumbers origins, ForeignNumbers directions) {
    return backend().trace_arrays(lens, direction, wavelength_nm, precision, surface_count, count, origins, directions);
}
CameraRayArrays generate_ray_arrays(int ordinal, const CameraSetup& setup, std::uint32_t spp, std::uint32_t seed,
                                    RayRange range) {
    return backend().generate_ray_arrays(ordinal, setup, spp, seed, range);
}
std::optional<int> gpu_of_address(const void* address) {
    return backend().gpu_of_address(address);
}
void wait_for_gpu(int ordinal, std::optional<std::uintptr_t> stream) {
    backend().wait_for_gpu(ordinal, stream);
}
void SharedDeviceArray::download(void* to) const {
    backend().download(*this, to);
}
SharedDeviceArray SharedDeviceArray::duplicate() const {
    return backend().duplicate(*this);
}
LensRayRates lens_ray_rates(int ordinal, const Camera& camera, PupilTracer tracer) {
    return backend().lens_ray_rates(ordinal, camera, std::move(tracer));
}
HitRates hit_rates(int ordinal, const Assembly& scene, const Camera& camera, PupilTracer tracer) {
    return backend().hit_rates(ordinal, scene, camera, std::move(tracer));
}

}  // namespace realcam

#endif
