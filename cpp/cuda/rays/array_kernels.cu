#include "array_kernels.hpp"

#include "../device/cuda_error.hpp"
#include "../device/launch_grid.hpp"

namespace realcam {
namespace {

// The kernels of array_kernels.hpp; a thread converts one number or one ray.

__global__ void widen(const float* from, std::int64_t count, double* to) {
    if (thread_index() < count) to[thread_index()] = static_cast<double>(from[thread_index()]);
}

__global__ void rays_to_scene(const __grid_constant__ RaysToScene rays) {
    const std::int64_t ray = thread_index();
    if (ray >= rays.range.count) return;
    const float* from = rays.relative + 3 * ray;
    double* to = rays.origins + 3 * ray;
    to[0] = rays.camera_position.x + static_cast<double>(from[0]);
    to[1] = rays.camera_position.y + static_cast<double>(from[1]);
    to[2] = rays.camera_position.z + static_cast<double>(from[2]);
    const double fraction = static_cast<double>(rays.shares[ray]);
    rays.times[ray] = rays.exposure.begin_s + fraction * (rays.exposure.end_s - rays.exposure.begin_s);
    rays.pixels[ray] = static_cast<int>((rays.range.first + ray) / rays.spp);
}

}  // namespace

void launch_widen(const float* from, std::int64_t count, double* to, cudaStream_t stream) {
    if (count == 0) return;
    widen<<<blocks_for(count), kBlockSize, 0, stream>>>(from, count, to);
    check_cuda(cudaGetLastError(), "starting to convert an array");
}

void launch_rays_to_scene(const RaysToScene& rays, cudaStream_t stream) {
    if (rays.range.count == 0) return;
    rays_to_scene<<<blocks_for(rays.range.count), kBlockSize, 0, stream>>>(rays);
    check_cuda(cudaGetLastError(), "starting to convert rays to scene space");
}

}  // namespace realcam
