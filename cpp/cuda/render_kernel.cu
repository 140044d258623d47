#include "render_kernel.hpp"

#include "cuda_error.hpp"
#include "lanes_per_pixel.hpp"
#include "render_kernel_template.hpp"

namespace realcam {
namespace {

__global__ void develop(const PixelSum* sums, std::int64_t pixels, double exposure_time_s, float* exposure,
                        float* depth) {
    const std::int64_t i = thread_index();
    if (i >= pixels) return;
    for (int c = 0; c < 3; ++c) exposure[3 * i + c] = sums[i].exposure(c, exposure_time_s);
    depth[i] = sums[i].mean_depth();
}

__global__ void develop_codes(const PixelSum* sums, std::int64_t pixels, double exposure_time_s, double iso,
                              ToneCurve curve, std::uint8_t* codes) {
    const std::int64_t i = thread_index();
    if (i >= pixels) return;
    for (int c = 0; c < 3; ++c) codes[3 * i + c] = sums[i].code(c, exposure_time_s, iso, curve);
}

__global__ void count(const PixelSum* sums, std::int64_t pixels, std::int64_t* counts) {
    const std::int64_t i = thread_index();
    if (i < pixels) counts[i] = static_cast<std::int64_t>(sums[i].samples);
}

__global__ void merge(PixelSum* sums, const PixelSum* other, std::int64_t pixels) {
    const std::int64_t i = thread_index();
    if (i < pixels) sums[i] += other[i];
}

template <int effects>
RenderKernel kernel_for(SceneKind scene_kind, LensKind lens_kind, bool instanced, bool timed) {
    const auto of_kind = [&]<SceneKind known>() {
        return lens_kind == LensKind::plain ? render_kernel_of<LensKind::plain, known, effects>(instanced, timed)
                                            : render_kernel_of<LensKind::any, known, effects>(instanced, timed);
    };
    switch (scene_kind) {
        case SceneKind::plain: return of_kind.template operator()<SceneKind::plain>();
        case SceneKind::opaque: return of_kind.template operator()<SceneKind::opaque>();
        default: return of_kind.template operator()<SceneKind::any>();
    }
}

}  // namespace

void check_render_code() {
    cudaFuncAttributes attributes{};
    const auto kernel = render_kernel_of<LensKind::any, SceneKind::any>(true, false);
    check_cuda(cudaFuncGetAttributes(&attributes, reinterpret_cast<const void*>(kernel)), "loading its code");
}

void launch_render(const RenderJob& job, bool timed, cudaStream_t stream) {
    const int lanes = lanes_per_pixel(static_cast<std::int64_t>(job.camera.width) * job.row_count, job.sample_count);
    const WarpTiles tiles(lanes);
    const unsigned blocks = blocks_for(tiles.across(job.camera.width) * tiles.down(job.row_count) * kWarpSize);
    const bool instanced = job.scene.instance_count > 0;
    const auto choose =
        job.camera.dispersion.cell_count > 0 ? kernel_for<number_of(kDispersion)> : kernel_for<number_of(kNoEffects)>;
    const RenderKernel kernel = choose(kind_of(job.scene, job.camera), job.camera.lens.kind, instanced, timed);
    kernel<<<blocks, kBlockSize, 0, stream>>>(job, lanes);
    check_cuda(cudaGetLastError(), "starting to render");
}

void launch_develop(const PixelSum* sums, std::int64_t pixels, double exposure_time_s, float* exposure, float* depth,
                    cudaStream_t stream) {
    develop<<<blocks_for(pixels), kBlockSize, 0, stream>>>(sums, pixels, exposure_time_s, exposure, depth);
    check_cuda(cudaGetLastError(), "starting to develop");
}

void launch_develop_codes(const PixelSum* sums, std::int64_t pixels, double exposure_time_s, double iso,
                          ToneCurve curve, std::uint8_t* codes, cudaStream_t stream) {
    develop_codes<<<blocks_for(pixels), kBlockSize, 0, stream>>>(sums, pixels, exposure_time_s, iso, curve, codes);
    check_cuda(cudaGetLastError(), "starting to develop");
}

void launch_count(const PixelSum* sums, std::int64_t pixels, std::int64_t* counts, cudaStream_t stream) {
    count<<<blocks_for(pixels), kBlockSize, 0, stream>>>(sums, pixels, counts);
    check_cuda(cudaGetLastError(), "starting to count samples");
}

void launch_merge(PixelSum* sums, const PixelSum* other, std::int64_t pixels, cudaStream_t stream) {
    merge<<<blocks_for(pixels), kBlockSize, 0, stream>>>(sums, other, pixels);
    check_cuda(cudaGetLastError(), "starting to add sums");
}

}  // namespace realcam
