#pragma once
#include "bvh_scene.hpp"
#include "launch_grid.hpp"
#include "render_kernel_of.hpp"
#include "warp_tiles.hpp"

// The kernel that takes samples, for nvcc alone. cmake/RealcamRenderKernels.cmake says for what it is instantiated.

namespace realcam {

namespace render_kernel_detail {

/// Six blocks of four warps hide more latency than four hold registers: 4% faster on an H200 for all that is spilled.
constexpr int kBlocksPerMultiprocessor = 6;

struct NoClock {
    __device__ void enter(RenderStage) {}
    __device__ void report(RenderCounts*) const {}
};

/// Clocks of one thread. Of each stage 32 bits: a thread's share of a launch is short.
struct StageClock {
    std::uint32_t clocks[3] = {0, 0, 0};
    std::uint32_t since;
    RenderStage stage = RenderStage::other;

    __device__ StageClock() : since(now()) {}
    __device__ void enter(RenderStage next) {
        const std::uint32_t time = now();
        for (int i = 0; i < 3; ++i) clocks[i] += i == static_cast<int>(stage) ? time - since : 0u;
        since = time;
        stage = next;
    }
    __device__ static std::uint32_t now() {
        std::uint32_t time;
        asm volatile("mov.u32 %0, %%clock;" : "=r"(time));
        return time;
    }
    __device__ void report(RenderCounts* counts) const {
        const unsigned long long lens = clocks[static_cast<int>(RenderStage::lens)],
                                 scene = clocks[static_cast<int>(RenderStage::scene)];
        atomicAdd(&counts->lens_clocks, lens);
        atomicAdd(&counts->scene_clocks, scene);
        atomicAdd(&counts->all_clocks, lens + scene + clocks[static_cast<int>(RenderStage::other)]);
    }
};

/// How many samples a pixel of the job's band takes.
__device__ inline std::uint32_t samples_of(const RenderJob& job, std::int64_t pixel) {
    if (!job.of_pixels) return job.sample_count;
    const std::uint32_t wanted = job.of_pixels[pixel];
    return wanted > job.pixels_taken ? min(wanted - job.pixels_taken, job.sample_count) : 0;
}

template <LensKind lens_kind, SceneKind scene_kind, int effects_number, bool instanced, class Clock>
__global__ void __launch_bounds__(kBlockSize, kBlocksPerMultiprocessor)
    render(const __grid_constant__ RenderJob job, int lanes_per_pixel) {
    constexpr Effects effects = kCompiledEffects[effects_number];
    const WarpTiles tiles(lanes_per_pixel);
    const int lane = threadIdx.x % kWarpSize;
    const auto [column, row] = tiles.pixel_of(thread_index(), job.camera.width);
    const bool inside = column < job.camera.width && row < job.row_count;

    // These are not in registers, because none are free and they are seldom wanted.
    __shared__ double squares[3][kBlockSize];
    for (auto& channel : squares) channel[threadIdx.x] = 0;
    PixelSum sum{};
    std::uint32_t sampled = 0, passed = 0;
    BvhScene<scene_kind, instanced> scene{job.scene, job.bvh, 0};
    Clock clock;
    if (inside) {
        SampleBlock<1> block;
        PathResults<1> results;
        block.column[0] = column;
        block.row[0] = job.first_row + row;
        block.used[0] = 1;
        block.stream[0] = pixel_stream(block.row[0] * job.camera.width + column, job.seed);
        const std::uint32_t count = samples_of(job, static_cast<std::int64_t>(row) * job.camera.width + column);
        std::uint32_t s = static_cast<std::uint32_t>(lane % tiles.lanes);
        for (; s < count; s += static_cast<std::uint32_t>(tiles.lanes)) {
            if (*job.stop) break;
            block.sample[0] = job.first_sample + s;
            render_samples<lens_kind, scene_kind, effects>(job.scene, job.camera, job.path, block, scene, clock,
                                                           results);
            sum.add(results, 0);
            if (job.adds_squares) {
                PixelSum added{};
                added.add_squares(results, 0);
                for (int c = 0; c < 3; ++c) squares[c][threadIdx.x] += added.squares[c];
            }
            sampled += static_cast<std::uint32_t>(results.sampled[0]);
            passed += static_cast<std::uint32_t>(results.passed[0]);
        }
        sum.samples = s / static_cast<std::uint32_t>(tiles.lanes);  // counted in the loop it would be spilled
        clock.enter(RenderStage::other);
    }
    for (double& e : sum.irradiance) e = sum_of_neighbours(e, tiles.lanes);
    if (job.adds_squares)
        for (int c = 0; c < 3; ++c) sum.squares[c] = sum_of_neighbours(squares[c][threadIdx.x], tiles.lanes);
    sum.depth = sum_of_neighbours(sum.depth, tiles.lanes);
    sum.met = sum_of_neighbours(sum.met, tiles.lanes);
    sum.samples = sum_of_neighbours(sum.samples, tiles.lanes);
    if (inside && lane % tiles.lanes == 0) job.sums[static_cast<std::int64_t>(row) * job.camera.width + column] += sum;

    sampled = sum_of_neighbours(sampled, kWarpSize);
    passed = sum_of_neighbours(passed, kWarpSize);
    const std::uint32_t traced = sum_of_neighbours(scene.rays_traced, kWarpSize);
    if (lane == 0) {
        atomicAdd(&job.counts->sampled_rays, sampled);
        atomicAdd(&job.counts->passed_rays, passed);
        atomicAdd(&job.counts->scene_rays, traced);
    }
    if (inside) clock.report(job.counts);
}

}  // namespace render_kernel_detail

template <LensKind lens_kind, SceneKind scene_kind, int effects>
RenderKernel render_kernel_of(bool instanced, bool timed) {
    using namespace render_kernel_detail;
    if (instanced)
        return timed ? render<lens_kind, scene_kind, effects, true, StageClock>
                     : render<lens_kind, scene_kind, effects, true, NoClock>;
    return timed ? render<lens_kind, scene_kind, effects, false, StageClock>
                 : render<lens_kind, scene_kind, effects, false, NoClock>;
}

}  // namespace realcam
