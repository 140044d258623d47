#include "render_kernel.hpp"

#include "../../render/path/path_settings.hpp"
#include "../device/cuda_error.hpp"
#include "../device/launch_grid.hpp"
#include "lanes_per_pixel.hpp"
#include "warp_tiles.hpp"

namespace realcam {
namespace {

/// Calls visit(channel, exposure in lux seconds) for the channels of a pixel.
template <class Visit>
__device__ void expose(const FilmView& film, std::int64_t pixel, double exposure_time_s, Visit&& visit) {
    PixelNeighbourhood around;
    if (film.control_variates.any()) {
        const int column = static_cast<int>(pixel % film.width), row = static_cast<int>(pixel / film.width);
        around = PixelNeighbourhood::around(column, film.width, [&](int x) { return film.column_around(x, row); });
    }
    film.for_channels(pixel, around, [&](int c, double splatted, double factor) {
        visit(c, film.pixels[pixel].exposure(c, exposure_time_s, splatted, factor));
    });
}

// In the next four kernels, a thread processes one pixel.

__global__ void develop(FilmView film, double exposure_time_s, float* exposure, float* depth) {
    const std::int64_t i = thread_index();
    if (i >= film.pixel_count()) return;
    expose(film, i, exposure_time_s, [&](int c, float lux_s) { exposure[3 * i + c] = lux_s; });
    depth[i] = film.pixels[i].mean_depth();
}

__global__ void develop_codes(FilmView film, double exposure_time_s, double iso, ToneCurve curve, std::uint8_t* codes) {
    const std::int64_t i = thread_index();
    if (i >= film.pixel_count()) return;
    expose(film, i, exposure_time_s, [&](int c, float lux_s) {
        codes[3 * i + c] = srgb_code(apply_tone_curve(curve, sensor_value(static_cast<double>(lux_s), iso)));
    });
}

__global__ void count(const PixelSum* sums, std::int64_t pixels, std::int64_t* counts) {
    const std::int64_t i = thread_index();
    if (i < pixels) counts[i] = static_cast<std::int64_t>(sums[i].samples);
}

__global__ void merge(PixelSum* sums, const PixelSum* other, std::int64_t pixels) {
    const std::int64_t i = thread_index();
    if (i < pixels) sums[i] += other[i];
}

/// A compiled render kernel and the jobs that it can run.
struct CompiledKernel {
    int effects;  ///< index in kCompiledEffects
    LensKind lens;
    SceneKind scene;
    bool halves;
    RenderKernel (*kernel_of)(bool instanced);  ///< instance of render_kernel_of

    /// Returns true if the kernel can run a job.
    bool serves(const RenderJob& job) const {
        const SceneKind scene_kind = kernel_scene_kind(job.scene, job.camera);
        return halves == job.adds_half && effects == number_of(job.camera.effects) &&
               lens >= kernel_lens_kind(job.camera) && (scene == SceneKind::any || scene == scene_kind);
    }
};

/// All compiled kernels; the list is made by cmake/RealcamRenderKernels.cmake.
constexpr CompiledKernel kKernels[] = {
#define REALCAM_RENDER_KERNEL(effects, lens, scene, halves) \
    {effects, LensKind::lens, SceneKind::scene, halves,     \
     render_kernel_of<LensKind::lens, SceneKind::scene, effects, halves>},
#include "render_kernels.inc"
#undef REALCAM_RENDER_KERNEL
};

/// Returns the first kernel that can run a job. A kernel also serves lens kinds that precede its own in the
/// enumeration. The last kernels of each set of effects serve any lens and any scene, with and without dual-pixel
/// halves.
RenderKernel kernel_for(const RenderJob& job) {
    const CompiledKernel* kernel = kKernels;
    while (!kernel->serves(job)) ++kernel;
    return kernel->kernel_of(job.scene.instance_count > 0);
}

}  // namespace

void check_render_code() {
    cudaFuncAttributes attributes{};
    const RenderKernel kernel = render_kernel_of<LensKind::any, SceneKind::any, 0, false>(true);
    check_cuda(cudaFuncGetAttributes(&attributes, reinterpret_cast<const void*>(kernel)), "loading its code");
}

void launch_render(const RenderJob& job, std::int64_t pixels, cudaStream_t stream) {
    const int lanes = lanes_per_pixel(pixels, job.sample_count);
    const WarpTiles tiles(lanes);
    const unsigned blocks = blocks_for(tiles.across(job.camera.width) * tiles.down(job.row_count) * kWarpSize);
    const RenderKernel kernel = kernel_for(job);
    kernel<<<blocks, kBlockSize, 0, stream>>>(job, lanes);
    check_cuda(cudaGetLastError(), "starting to render");
}

void launch_develop(const FilmView& film, double exposure_time_s, float* exposure, float* depth, cudaStream_t stream) {
    develop<<<blocks_for(film.pixel_count()), kBlockSize, 0, stream>>>(film, exposure_time_s, exposure, depth);
    check_cuda(cudaGetLastError(), "starting to develop");
}

void launch_develop_codes(const FilmView& film, double exposure_time_s, double iso, ToneCurve curve,
                          std::uint8_t* codes, cudaStream_t stream) {
    develop_codes<<<blocks_for(film.pixel_count()), kBlockSize, 0, stream>>>(film, exposure_time_s, iso, curve, codes);
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
