#pragma once
#include <cuda_runtime.h>

#include "../../bvh/wide_bvh.hpp"
#include "../../camera/models/camera_view.hpp"
#include "../../render/ghosts/ghost_film.hpp"

namespace realcam {

/// Parameters of a launch over some blocks of splatted samples (GhostBlocks). All pointers are device pointers.
struct GhostJob {
    SceneView scene;
    SceneBvhView bvh;
    CameraView camera;
    GhostView ghosts;
    const volatile int* stop;  ///< if the value is not 0, no further block starts
    GhostSum* sums;  ///< for all pixels, film by film; results are added
    int films;  ///< 1, or 2: for blocks with even and with odd indices
    unsigned long long* blocks_done;  ///< number of completed blocks of each film; incremented
    std::uint64_t first_block;
    std::uint32_t block_count, seed;
    PathSettings settings;
    double units_per_lux;
};

// Launch a kernel asynchronously, which must fit GhostView::light of the job: ghosts and starbursts of lights, ghosts
// of objects, or images of lights. Throw DeviceError.
void launch_splat_ghosts(const GhostJob& job, cudaStream_t stream);
void launch_gather_ghosts(const GhostJob& job, cudaStream_t stream);
void launch_trace_lights(const GhostJob& job, cudaStream_t stream);

}  // namespace realcam
