#pragma once
#include "../../camera/ray_request.hpp"
#include "../device/launch_grid.hpp"
#include "bvh_scene.hpp"
#include "exact_sums.hpp"
#include "render_kernel.hpp"
#include "warp_tiles.hpp"

// The render kernel, for nvcc only. cmake/RealcamRenderKernels.cmake lists its instantiations.

namespace realcam {

namespace render_kernel_detail {

/// With six blocks of four warps, registers are spilled to memory; with four blocks they are not. Six are 4% faster on
/// an H200 nevertheless, because they hide more latency.
constexpr int kBlocksPerMultiprocessor = 6;

/// Probe of advance_paths that measures the clock cycles of each stage, in the first thread of every sixteenth block.
/// Counts are in shared memory, because no registers are free while a ray is traced.
class StageClock {
public:
    struct Count {
        std::uint32_t clocks[3];  ///< per stage; 32 bits suffice for a launch, which is short
        std::uint32_t since;  ///< clock at which the current stage began
        RenderStage stage;
    };

    __device__ explicit StageClock(Count& count) : count_(count) {
        if (measures()) count_ = {{0, 0, 0}, now(), RenderStage::other};
    }
    __device__ void enter(RenderStage next) {
        if (!measures()) return;
        const std::uint32_t time = now();
        count_.clocks[static_cast<int>(count_.stage)] += time - count_.since;
        count_.since = time;
        count_.stage = next;
    }
    /// Adds the cycles to the counters of all launches.
    __device__ void report(RenderCounts* counts) {
        if (!measures()) return;
        enter(RenderStage::other);
        const unsigned long long lens = count_.clocks[static_cast<int>(RenderStage::lens)],
                                 scene = count_.clocks[static_cast<int>(RenderStage::scene)];
        atomicAdd(&counts->lens_clocks, lens);
        atomicAdd(&counts->scene_clocks, scene);
        atomicAdd(&counts->all_clocks, lens + scene + count_.clocks[static_cast<int>(RenderStage::other)]);
    }

private:
    __device__ static bool measures() { return blockIdx.x % 16 == 0 && threadIdx.x == 0; }
    __device__ static std::uint32_t now() {
        std::uint32_t time;
        asm volatile("mov.u32 %0, %%clock;" : "=r"(time));
        return time;
    }

    Count& count_;
};

/// Sums of each thread for its pixel, in shared memory because no registers are free: the doubles of PixelSum. Index:
/// irradiance 0 to 2, depth 3, met 4, auxiliary 5 to 7.
struct ThreadSums {
    double sums[8][kBlockSize];

    /// Returns one of the sums of this thread.
    __device__ double& operator[](int i) { return sums[i][threadIdx.x]; }
    __device__ void clear() {
        for (int i = 0; i < 8; ++i) (*this)[i] = 0;
    }
    /// Adds a sample. `has_auxiliary`: true if PixelSum::auxiliary is in use.
    __device__ void add(const PixelSum& sample, bool has_auxiliary) {
        for (int c = 0; c < 3; ++c) (*this)[c] += sample.irradiance[c];
        (*this)[3] += sample.depth;
        (*this)[4] += sample.met;
        if (!has_auxiliary) return;
        for (int c = 0; c < 3; ++c) (*this)[5 + c] += sample.auxiliary[c];
    }
    /// Returns the sum over all threads of the pixel, without the sample counts. `lanes`: number of these threads.
    __device__ PixelSum of_pixel(int lanes) {
        PixelSum sum{};
        for (int c = 0; c < 3; ++c) sum.irradiance[c] = sum_of_neighbours((*this)[c], lanes);
        sum.depth = sum_of_neighbours((*this)[3], lanes);
        sum.met = sum_of_neighbours((*this)[4], lanes);
        for (int c = 0; c < 3; ++c) sum.auxiliary[c] = sum_of_neighbours((*this)[5 + c], lanes);
        return sum;
    }
};

/// Adds a sample's contributions to pixels other than its own.
template <Effects effects>
__device__ inline void add_shared(const SampleBlock<1>& block, const PathResultsWith<1, effects>& results,
                                  PixelSum* own) {
    for (int step = 0; step < kSharedWavelengths - 1; ++step) {
        const std::int32_t away = results.shared.away[step][0];
        if (away == 0) continue;
        const float dither = unit_float(block.bits(0, static_cast<std::uint32_t>(step)));
        const Color c = results.shared.irradiance[step][0];
        if (!is_black(c)) add_exact(own[away].irradiance, c, dither);
        add_exact(own[away].auxiliary, results.shared.white[step][0], dither);
    }
}

/// Returns the number of samples that a pixel of the job takes (PixelCounts::of).
__device__ inline std::uint32_t samples_of(const RenderJob& job, std::int64_t pixel) {
    if (!job.pixel_counts) return job.sample_count;
    const std::uint32_t count = job.pixel_counts[pixel];
    return count > job.pixels_taken ? min(count - job.pixels_taken, job.sample_count) : 0;
}

/// Sets PixelSum::auxiliary of a sample: its excess or its squares. Returns true if the job uses these.
template <Effects effects>
__device__ inline bool add_auxiliary(const RenderJob& job, const PathResultsWith<1, effects>& results,
                                     PixelSum& sample) {
    if constexpr (effects.have_wavelengths()) {
        if (job.adds_excess) {
            sample.add_excess(results.excess[0]);
            return true;
        }
    }
    sample.add_squares(results, 0);
    return job.adds_squares;
}

/// Renders samples of pixels. Each pixel has `lanes_per_pixel` threads, which share its samples.
template <LensKind lens_kind, SceneKind scene_kind, int effects_number, bool instanced, bool halves = false>
__global__ void __launch_bounds__(kBlockSize, kBlocksPerMultiprocessor)
    render(const __grid_constant__ RenderJob job, int lanes_per_pixel) {
    constexpr Effects effects = kCompiledEffects[effects_number];
    const WarpTiles tiles(lanes_per_pixel);
    const int lane = threadIdx.x % kWarpSize;
    const auto [column, row] = tiles.pixel_of(thread_index(), job.camera.width);
    const bool inside = column < job.camera.width && row < job.row_count;
    const std::int64_t pixel = static_cast<std::int64_t>(row) * job.camera.width + column;
    const bool shares = effects.share_pixels() && !halves && job.camera.dispersion.sharing.part.width > 0;

    __shared__ ThreadSums sums;
    __shared__ StageClock::Count clocks;
    sums.clear();
    std::uint32_t samples = 0, sampled = 0, passed = 0;
    BvhScene<scene_kind, instanced> scene{job.scene, job.bvh, 0};
    StageClock clock(clocks);
    if (inside) {
        SampleBlock<1> block;
        PathResultsWith<1, effects> results;
        block.column[0] = column;
        block.row[0] = job.first_row + row;
        block.used[0] = 1;
        block.stream[0] = pixel_stream(block.row[0] * job.camera.width + column, job.seed);
        const std::uint32_t count = samples_of(job, pixel);
        std::uint32_t s = static_cast<std::uint32_t>(lane % tiles.lanes);
        for (; s < count; s += static_cast<std::uint32_t>(tiles.lanes)) {
            if (*job.stop) break;
            block.sample[0] = job.first_sample + s;
            render_samples<lens_kind, scene_kind, effects>(job.scene, job.camera, job.path, block, scene, clock,
                                                           results);
            PixelSum sample{};
            sample.add(results, 0);
            if constexpr (halves) {
                Lanes<std::int32_t, 1> is_right;
                find_right_half<effects>(job.camera, block, is_right);
                sample.add_half(results, 0, is_right[0] != 0);
                sums.add(sample, true);
            } else {
                const bool has_auxiliary = add_auxiliary<effects>(job, results, sample);
                sums.add(sample, has_auxiliary);
            }
            if constexpr (effects.share_pixels())
                if (shares) add_shared(block, results, job.sums + pixel);
            sampled += static_cast<std::uint32_t>(results.sampled[0]);
            passed += static_cast<std::uint32_t>(results.passed[0]);
        }
        samples = s / static_cast<std::uint32_t>(tiles.lanes);  // a counter in the loop would be spilled to memory
    }
    PixelSum sum = sums.of_pixel(tiles.lanes);
    sum.samples = sum_of_neighbours(samples, tiles.lanes);
    sum.passed = sum_of_neighbours(passed, tiles.lanes);
    if (inside && lane % tiles.lanes == 0) {
        if (shares) {
            const std::uint32_t bits =
                hash32(pixel_stream((job.first_row + row) * job.camera.width + column, job.seed), job.first_sample);
            for (int c = 0; c < 3; ++c) {
                add_exact(job.sums[pixel].irradiance[c], sum.irradiance[c], unit_float(bits));
                add_exact(job.sums[pixel].auxiliary[c], sum.auxiliary[c], unit_float(bits));
            }
            job.sums[pixel].add_all_but_colours(sum);
        } else {
            job.sums[pixel] += sum;
        }
    }

    sampled = sum_of_neighbours(sampled, kWarpSize);
    passed = sum_of_neighbours(passed, kWarpSize);
    const std::uint32_t traced = sum_of_neighbours(scene.rays_traced, kWarpSize);
    if (lane == 0) {
        atomicAdd(&job.counts->sampled_rays, sampled);
        atomicAdd(&job.counts->passed_rays, passed);
        atomicAdd(&job.counts->scene_rays, traced);
    }
    clock.report(job.counts);
}

}  // namespace render_kernel_detail

template <LensKind lens_kind, SceneKind scene_kind, int effects, bool halves>
RenderKernel render_kernel_of(bool instanced) {
    using namespace render_kernel_detail;
    return instanced ? render<lens_kind, scene_kind, effects, true, halves>
                     : render<lens_kind, scene_kind, effects, false, halves>;
}

}  // namespace realcam
