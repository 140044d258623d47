#pragma once
#include "ghost_kernels.hpp"

// Common parts of the ghost kernels, for nvcc only. A thread block takes one block of samples, which share one optical
// path through the lens.

namespace realcam {

/// Returns true if the launch is stopped. All threads of a block must call it, and get the same result.
__device__ inline bool is_stopped(const GhostJob& job) {
    __shared__ int stopped;
    if (threadIdx.x == 0) stopped = *job.stop;
    __syncthreads();
    return stopped != 0;
}

/// Returns the block of samples that this thread block takes.
__device__ inline GhostRange range_of(const GhostJob& job) {
    return {job.first_block + blockIdx.x, job.seed};
}

/// Callback splat(pixel, irradiance, dither) of splat_ghosts: adds to the film of the block.
struct GhostSplat {
    const GhostJob& job;

    __device__ void operator()(std::int32_t pixel, Color lux, float dither) const {
        const std::int64_t film = film_of_block(range_of(job).first_block, job.films);
        GhostSum* const sums = job.sums + film * job.camera.width * job.camera.height;
        const float channels[3] = {lux.r, lux.g, lux.b};
        for (int c = 0; c < 3; ++c)
            atomicAdd(reinterpret_cast<unsigned long long*>(&sums[pixel].units[c]),
                      static_cast<unsigned long long>(ghost_units(channels[c], job.units_per_lux, dither)));
    }
};

/// Counts the block as complete.
__device__ inline void count_block(const GhostJob& job) {
    if (threadIdx.x == 0) atomicAdd(job.blocks_done + film_of_block(range_of(job).first_block, job.films), 1ull);
}

}  // namespace realcam
