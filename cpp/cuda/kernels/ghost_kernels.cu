#include "../../render/path/path_settings.hpp"
#include "../device/cuda_error.hpp"
#include "bvh_scene.hpp"
#include "ghost_kernels.hpp"
#include "ghost_sums.hpp"

namespace realcam {
namespace {

/// Traces ghosts and starbursts of lights. A thread block takes one block of samples, which share one optical path
/// through the lens; a thread takes one sample.
template <LensKind lens_kind, SceneKind scene_kind, bool instanced, bool has_wavelengths>
__global__ void __launch_bounds__(kGhostBlock, 2) splat_ghosts_of(const __grid_constant__ GhostJob job) {
    if (is_stopped(job)) return;
    BvhScene<scene_kind, instanced> scene{job.scene, job.bvh, 0};
    splat_ghosts<lens_kind, scene_kind, has_wavelengths, 1>(job.scene, job.camera, job.ghosts, range_of(job),
                                                            threadIdx.x, scene, GhostSplat{job});
    count_block(job);
}

}  // namespace

void launch_splat_ghosts(const GhostJob& job, cudaStream_t stream) {
    const bool plain = kernel_scene_kind(job.scene, job.camera) == SceneKind::plain && job.scene.instance_count == 0;
    const bool has_wavelengths = job.ghosts.effects.have_wavelengths();
    constexpr LensKind round = LensKind::rotational, any = LensKind::any;
    auto* kernel = plain ? (has_wavelengths ? splat_ghosts_of<round, SceneKind::plain, false, true>
                                            : splat_ghosts_of<round, SceneKind::plain, false, false>)
                         : (has_wavelengths ? splat_ghosts_of<round, SceneKind::any, true, true>
                                            : splat_ghosts_of<round, SceneKind::any, true, false>);
    if (needs_general_lens_code(job.camera))
        kernel = has_wavelengths ? splat_ghosts_of<any, SceneKind::any, true, true>
                                 : splat_ghosts_of<any, SceneKind::any, true, false>;
    kernel<<<job.block_count, kGhostBlock, 0, stream>>>(job);
    check_cuda(cudaGetLastError(), "starting to trace ghosts");
}

}  // namespace realcam
