#include "../../render/lights/trace_lights.hpp"
#include "../../render/path/path_settings.hpp"
#include "../device/cuda_error.hpp"
#include "bvh_scene.hpp"
#include "ghost_sums.hpp"

namespace realcam {
namespace {

/// Traces the images of lights; a thread takes one sample. Separate from the ghost kernel because of its different
/// register usage.
template <LensKind lens_kind, SceneKind scene_kind, bool instanced, bool has_wavelengths>
__global__ void __launch_bounds__(kGhostBlock, 2) trace_lights_of(const __grid_constant__ GhostJob job) {
    if (is_stopped(job)) return;
    BvhScene<scene_kind, instanced> scene{job.scene, job.bvh, 0};
    trace_lights<lens_kind, scene_kind, has_wavelengths, 1>(job.scene, job.camera, job.ghosts, range_of(job),
                                                            threadIdx.x, scene, GhostSplat{job});
    count_block(job);
}

}  // namespace

void launch_trace_lights(const GhostJob& job, cudaStream_t stream) {
    const bool plain = kernel_scene_kind(job.scene, job.camera) == SceneKind::plain && job.scene.instance_count == 0;
    const bool has_wavelengths = job.ghosts.effects.have_wavelengths();
    constexpr LensKind round = LensKind::rotational, any = LensKind::any;
    auto* kernel = plain ? (has_wavelengths ? trace_lights_of<round, SceneKind::plain, false, true>
                                            : trace_lights_of<round, SceneKind::plain, false, false>)
                         : (has_wavelengths ? trace_lights_of<round, SceneKind::any, true, true>
                                            : trace_lights_of<round, SceneKind::any, true, false>);
    if (needs_general_lens_code(job.camera))
        kernel = has_wavelengths ? trace_lights_of<any, SceneKind::any, true, true>
                                 : trace_lights_of<any, SceneKind::any, true, false>;
    kernel<<<job.block_count, kGhostBlock, 0, stream>>>(job);
    check_cuda(cudaGetLastError(), "starting to trace lights");
}

}  // namespace realcam
