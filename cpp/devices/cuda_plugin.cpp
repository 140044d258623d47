#include "cuda_plugin.hpp"

#include <dlfcn.h>

#include "../cuda/cuda_backend.hpp"

namespace realcam {
namespace {

/// Part of the messages that says what to install.
constexpr const char* kAdvice = "`pip install --force-reinstall realcam[cuda]` installs matching versions";

/// Throws DeviceError with the last error of the dynamic loader.
[[noreturn]] void fail_to_load() {
    const char* error = dlerror();
    throw DeviceError("the CUDA plug-in cannot be loaded: " + std::string(error ? error : "no reason is given") + "; " +
                      kAdvice + "; or use device=\"cpu\"");
}

/// Returns a function of a library by its symbol. Throws DeviceError if it is missing.
template <class F>
F* find(void* library, const char* name) {
    void* const found = dlsym(library, name);
    if (!found) fail_to_load();
    return reinterpret_cast<F*>(found);
}

}  // namespace

const CudaBackend& load_cuda_plugin(const std::string& path) {
    static constexpr CudaHost host = {build_scene_bvh, refit_instances, bvh_instances};
    void* const library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) fail_to_load();
    const std::string stamp = find<CudaPluginStamp>(library, kCudaPluginStamp)();
    if (stamp != cuda_backend_stamp())
        throw DeviceError("the CUDA plug-in " + path + " was built for realcam " + stamp + "; this is realcam " +
                          cuda_backend_stamp() + "; " + kAdvice + "; or use device=\"cpu\"");
    return *find<CudaPluginBackend>(library, kCudaPluginBackend)(&host);
}

}  // namespace realcam
