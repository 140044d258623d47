// A plug-in without a GPU, for tests of what loads it: its GPU is one that the code is not compiled for.
#include "cuda/cuda_backend.hpp"

namespace realcam {
namespace {

CudaDevice thrown(int ordinal) {
    switch (ordinal) {
        case 1: throw InputError("an input");
        case 2: throw DeviceError("a device");
        case 3: throw UnsupportedGpu("a GPU");
        case 4: throw Cancelled();
        default: return {ordinal, "GPU of the tests", 6, 1, 20, std::size_t{8} << 30};
    }
}

const CudaHost* host_of_all = nullptr;

constexpr CudaBackend kBackend = {
    .cuda_devices = [] { return std::vector<CudaDevice>{thrown(0)}; },
    .why_no_cuda_device = [] { return std::string(); },
    .cuda_device = thrown,
    .make_cuda_session = [](const std::vector<int>&, PupilTracer) -> std::unique_ptr<Session> {
        throw UnsupportedGpu("the tests have no code for the GPU");
    },
    .make_cuda_gradient = nullptr,
    .trace_rays_on_gpu = nullptr,
    .trace_arrays = nullptr,
    .generate_ray_arrays = nullptr,
    .gpu_of_address = nullptr,
    .wait_for_gpu = nullptr,
    .download = nullptr,
    .duplicate = nullptr,
    .lens_ray_rates = nullptr,
    .hit_rates = [](int, const Assembly& scene, const Camera& camera, PupilTracer) -> HitRates {
        const RenderSpaceScene placed(scene, position_when_open(camera), camera.exposure());
        const SceneBvh bvh = host_of_all->build_scene_bvh(placed, {});
        const auto nodes = static_cast<double>(bvh.static_geometry.nodes.size());
        return {.build_seconds = 0, .upload_seconds = 0, .camera_rays = nodes, .bounce_rays = 0, .uniform_rays = 0};
    },
};

}  // namespace
}  // namespace realcam

extern "C" {

__attribute__((visibility("default"))) const char* realcam_cuda_stamp() {
#if defined(REALCAM_OTHER_STAMP)
    return "9.8.7 (build of the tests)";
#else
    return realcam::cuda_backend_stamp();
#endif
}

__attribute__((visibility("default"))) const realcam::CudaBackend* realcam_cuda_backend(const realcam::CudaHost* host) {
    realcam::host_of_all = host;
    return &realcam::kBackend;
}
}
