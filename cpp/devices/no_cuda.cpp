// What the CUDA backend offers, where it was not built.
#if !defined(REALCAM_HAS_CUDA)

#include "../cuda/bench_kernels.hpp"
#include "../cuda/cuda_devices.hpp"
#include "../cuda/cuda_rays.hpp"
#include "../cuda/cuda_session.hpp"
#include "../cuda/foreign_memory.hpp"
#include "../cuda/ray_arrays.hpp"
#include "../error.hpp"

namespace realcam {
namespace {

[[noreturn]] void fail() {
    throw DeviceError(why_no_cuda_device());
}

}  // namespace

std::vector<CudaDevice> cuda_devices() {
    return {};
}
std::string why_no_cuda_device() {
    return "this build of realcam has no CUDA backend: the device \"cpu\" works, and a build from the source with "
           "nvcc has GPUs, too";
}
CudaDevice cuda_device(int) {
    fail();
}
std::unique_ptr<Session> make_cuda_session(const std::vector<int>&, PupilTracer) {
    fail();
}
void trace_rays_on_gpu(int, const LensSystem&, LightDirection, double, Precision, int, std::int64_t, const double*,
                       const double*, const TracedRays&) {
    fail();
}
TracedArrays trace_arrays(const LensSystem&, LightDirection, double, Precision, int, std::int64_t, ForeignNumbers,
                          ForeignNumbers) {
    fail();
}
CameraRayArrays generate_ray_arrays(int, const CameraSetup&, std::uint32_t, std::uint32_t, RayRange) {
    fail();
}
std::optional<int> gpu_of_address(const void*) {
    fail();
}
void wait_for_gpu(int, std::optional<std::uintptr_t>) {
    fail();
}
void SharedDeviceArray::download(void*) const {
    fail();
}
SharedDeviceArray SharedDeviceArray::duplicate() const {
    fail();
}

LensRayRates lens_ray_rates(int, const Camera&, PupilTracer) {
    fail();
}
HitRates hit_rates(int, const Assembly&, const Camera&, PupilTracer) {
    fail();
}

}  // namespace realcam

#endif
