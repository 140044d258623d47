// The CUDA backend as a library of its own (plug-in): the functions that it exports, and stand-ins for the functions
// that it calls in the program which loads it.
#include "../cuda/cuda_backend.hpp"

namespace realcam {
namespace {

/// Functions of the program that has loaded the plug-in; set by realcam_cuda_backend.
const CudaHost* host = nullptr;

constexpr CudaBackend kBackend = {
    .cuda_devices = cuda_devices,
    .why_no_cuda_device = why_no_cuda_device,
    .cuda_device = cuda_device,
    .make_cuda_session = make_cuda_session,
    .make_cuda_gradient = make_cuda_gradient,
    .trace_rays_on_gpu = trace_rays_on_gpu,
    .trace_arrays = trace_arrays,
    .generate_ray_arrays = generate_ray_arrays,
    .gpu_of_address = gpu_of_address,
    .wait_for_gpu = wait_for_gpu,
    .download = [](const SharedDeviceArray& array, void* to) { array.download(to); },
    .duplicate = [](const SharedDeviceArray& array) { return array.duplicate(); },
    .lens_ray_rates = lens_ray_rates,
    .hit_rates = hit_rates,
};

}  // namespace

SceneBvh build_scene_bvh(const RenderSpaceScene& scene, const KeepGoing& keep_going) {
    return host->build_scene_bvh(scene, keep_going);
}
void refit_instances(SceneBvh& bvh, const RenderSpaceScene& scene) {
    host->refit_instances(bvh, scene);
}
std::vector<BvhInstance> bvh_instances(const SceneBvh& bvh, const RenderSpaceScene& scene,
                                       const std::vector<WideBvhView>& objects) {
    return host->bvh_instances(bvh, scene, objects);
}

}  // namespace realcam

extern "C" {

__attribute__((visibility("default"))) const char* realcam_cuda_stamp() {
    return realcam::cuda_backend_stamp();
}

__attribute__((visibility("default"))) const realcam::CudaBackend* realcam_cuda_backend(const realcam::CudaHost* host) {
    realcam::host = host;
    return &realcam::kBackend;
}
}
