// Kernels for rays: the CPU's loops over blocks of rays, with one ray (a block of one lane) per thread.
#include "../device/cuda_error.hpp"
#include "../device/launch_grid.hpp"
#include "ray_kernels.hpp"

namespace realcam {
namespace {

template <class T>
__global__ void __launch_bounds__(kBlockSize) trace(const __grid_constant__ TraceRequest<T> request) {
    if (thread_index() < request.count) trace_ray_block<1>(request, thread_index());
}

template <LensKind lens_kind>
__global__ void __launch_bounds__(kBlockSize) generate(const __grid_constant__ RayRequest request) {
    if (thread_index() < request.count()) generate_rays_of<lens_kind, 1>(request, thread_index());
}

/// Launches the trace of a request in the precision T.
template <class T>
void launch(const TraceRequest<T>& request, cudaStream_t stream) {
    if (request.count == 0) return;
    trace<<<blocks_for(request.count), kBlockSize, 0, stream>>>(request);
    check_cuda(cudaGetLastError(), "starting to trace");
}

}  // namespace

void launch_trace(const TraceRequest<double>& request, cudaStream_t stream) {
    launch(request, stream);
}
void launch_trace(const TraceRequest<float>& request, cudaStream_t stream) {
    launch(request, stream);
}

void launch_generate(const RayRequest& request, cudaStream_t stream) {
    if (request.count() == 0) return;
    // Spherical lenses use the kernel for rotationally symmetric ones: this is not worth a kernel of its own.
    auto* const kernel =
        needs_general_lens_code(request.camera) ? generate<LensKind::any> : generate<LensKind::rotational>;
    kernel<<<blocks_for(request.count()), kBlockSize, 0, stream>>>(request);
    check_cuda(cudaGetLastError(), "starting to generate rays");
}

}  // namespace realcam
