#include "../../render/ghosts/gather_ghosts.hpp"
#include "../device/cuda_error.hpp"
#include "bvh_scene.hpp"
#include "ghost_sums.hpp"

namespace realcam {
namespace {

/// Traces ghosts of objects; a thread takes one sample. One kernel for all scene kinds: these samples are few, and
/// kernels with whole paths take long to compile.
template <LensKind lens_kind, bool has_wavelengths>
__global__ void __launch_bounds__(kGhostBlock, 2) gather_ghosts_of(const __grid_constant__ GhostJob job) {
    if (is_stopped(job)) return;
    BvhScene<SceneKind::any, true> scene{job.scene, job.bvh, 0};
    gather_ghosts<lens_kind, SceneKind::any, has_wavelengths, 1>(job.scene, job.camera, job.settings, job.ghosts,
                                                                 range_of(job), threadIdx.x, scene, GhostSplat{job});
    count_block(job);
}

}  // namespace

void launch_gather_ghosts(const GhostJob& job, cudaStream_t stream) {
    constexpr LensKind round = LensKind::rotational, any = LensKind::any;
    auto* kernel =
        job.ghosts.effects.have_wavelengths() ? gather_ghosts_of<round, true> : gather_ghosts_of<round, false>;
    if (needs_general_lens_code(job.camera))
        kernel = job.ghosts.effects.have_wavelengths() ? gather_ghosts_of<any, true> : gather_ghosts_of<any, false>;
    kernel<<<job.block_count, kGhostBlock, 0, stream>>>(job);
    check_cuda(cudaGetLastError(), "starting to trace ghosts of objects");
}

}  // namespace realcam
