#pragma once
#include <cuda_runtime.h>

#include "../bvh/wide_bvh.hpp"
#include "../camera/camera_view.hpp"
#include "../render/ghost_film.hpp"

namespace realcam {

/// One launch: some blocks of ghost samples. All pointers are the device's.
struct GhostJob {
    SceneView scene;
    SceneBvhView bvh;
    CameraView camera;
    GhostView ghosts;
    const volatile int* stop;  ///< not 0: no block is begun
    GhostSum* sums;  ///< of all pixels, film by film; added to
    int films;       ///< 1, or 2: of blocks with even and with odd numbers
    unsigned long long* blocks_done;  ///< in each film
    std::uint64_t first_block;
    std::uint32_t block_count, seed;
    PathSettings settings;
    double units_per_lux;
};

/// The job's GhostView says which of them serves it: ghosts and starbursts of lights, ghosts of objects, or the lights
/// themselves. All throw DeviceError.
void launch_splat_ghosts(const GhostJob& job, cudaStream_t stream);
void launch_gather_ghosts(const GhostJob& job, cudaStream_t stream);
void launch_trace_lights(const GhostJob& job, cudaStream_t stream);

}  // namespace realcam
