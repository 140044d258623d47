#include "../../render/layers/trace_layers.hpp"
#include "../device/cuda_error.hpp"
#include "../device/launch_grid.hpp"
#include "bvh_scene.hpp"
#include "lanes_per_pixel.hpp"
#include "layer_kernels.hpp"
#include "warp_tiles.hpp"

namespace realcam {
namespace {

/// Returns the block with the first sample of a pixel. `row`: relative to the job's first row.
__device__ SampleBlock<1> block_at(const LayerJob& job, int column, int row) {
    SampleBlock<1> block;
    block.column[0] = column;
    block.row[0] = job.first_row + row;
    block.used[0] = 1;
    block.stream[0] = pixel_stream(block.row[0] * job.camera.width + column, job.seed);
    block.sample[0] = job.first_sample;
    return block;
}

/// Several threads share the samples of a pixel (WarpTiles).
template <bool instanced>
__global__ void trace_layers_of(const __grid_constant__ LayerJob job, int lanes_per_pixel, LayerSum* sums) {
    const WarpTiles tiles(lanes_per_pixel);
    const int lane = threadIdx.x % kWarpSize;
    const auto [column, row] = tiles.pixel_of(thread_index(), job.camera.width);
    const bool inside = column < job.camera.width && row < job.row_count;

    LayerSum sum{};
    if (inside) {
        SampleBlock<1> block = block_at(job, column, row);
        BvhScene<SceneKind::any, instanced> scene{job.scene, job.bvh, 0};
        LayerResults<1> results;
        const auto step = static_cast<std::uint32_t>(tiles.lanes);
        for (std::uint32_t s = static_cast<std::uint32_t>(lane % tiles.lanes); s < job.sample_count; s += step) {
            if (*job.stop) break;
            block.sample[0] = job.first_sample + s;
            trace_layers(job.scene, job.camera, block, scene, results);
            sum.add(results, 0);
        }
    }
    sum.weight = sum_of_neighbours(sum.weight, tiles.lanes);
    sum.met = sum_of_neighbours(sum.met, tiles.lanes);
    for (double& e : sum.normal) e = sum_of_neighbours(e, tiles.lanes);
    for (double& e : sum.albedo) e = sum_of_neighbours(e, tiles.lanes);
    sum.circle_mm = sum_of_neighbours(sum.circle_mm, tiles.lanes);
    if (inside && lane % tiles.lanes == 0) sums[static_cast<std::int64_t>(row) * job.camera.width + column] += sum;
}

template <bool instanced>
__global__ void trace_pixel_centres_of(const __grid_constant__ LayerJob job, PixelCentreSurface* surfaces) {
    const std::int64_t pixel = thread_index();
    if (pixel >= static_cast<std::int64_t>(job.row_count) * job.camera.width || *job.stop) return;
    const SampleBlock<1> block =
        block_at(job, static_cast<int>(pixel % job.camera.width), static_cast<int>(pixel / job.camera.width));
    BvhScene<SceneKind::any, instanced> scene{job.scene, job.bvh, 0};
    PixelCentreSurface surface[1];
    trace_pixel_centres(job.scene, job.camera, block, scene, surface);
    surfaces[pixel] = surface[0];
}

}  // namespace

void launch_trace_layers(const LayerJob& job, LayerSum* sums, cudaStream_t stream) {
    const int lanes = lanes_per_pixel(static_cast<std::int64_t>(job.camera.width) * job.row_count, job.sample_count);
    const WarpTiles tiles(lanes);
    const unsigned blocks = blocks_for(tiles.across(job.camera.width) * tiles.down(job.row_count) * kWarpSize);
    const auto kernel = job.scene.instance_count > 0 ? trace_layers_of<true> : trace_layers_of<false>;
    kernel<<<blocks, kBlockSize, 0, stream>>>(job, lanes, sums);
    check_cuda(cudaGetLastError(), "starting to trace layers");
}

void launch_trace_pixel_centres(const LayerJob& job, PixelCentreSurface* surfaces, cudaStream_t stream) {
    const unsigned blocks = blocks_for(static_cast<std::int64_t>(job.row_count) * job.camera.width);
    const auto kernel = job.scene.instance_count > 0 ? trace_pixel_centres_of<true> : trace_pixel_centres_of<false>;
    kernel<<<blocks, kBlockSize, 0, stream>>>(job, surfaces);
    check_cuda(cudaGetLastError(), "starting to trace layers");
}

}  // namespace realcam
