#include "cuda_plugin.hpp"

#include <dlfcn.h>

#include "../cuda/cuda_backend.hpp"

namespace realcam {
namespace {

constexpr const char* kAdvice = "`pip install --force-reinstall realcam[cuda]` installs both of one version";

[[noreturn]] void fail_to_load() {
    const char* error = dlerror();
    throw DeviceError("the CUDA plug-in cannot be loaded: " + std::string(error ? error : "no reason is given") + "; " +
                      kAdvice + ", and device=\"cpu\" works without");
}

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
        throw DeviceError("the CUDA plug-in " + path + " is of realcam " + stamp + ", and this is realcam " +
                          cuda_backend_stamp() + "; " + kAdvice + ", and device=\"cpu\" works without");
    return *find<CudaPluginBackend>(library, kCudaPluginBackend)(&host);
}

}  // namespace realcam
