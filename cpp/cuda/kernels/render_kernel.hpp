#pragma once
#include <cuda_runtime.h>

#include <cstdint>

#include "../../bvh/wide_bvh.hpp"
#include "../../camera/effects/effects.hpp"
#include "../../camera/models/camera_view.hpp"
#include "../../render/film/film_sums.hpp"
#include "../../render/film/pixel_sum.hpp"
#include "../../render/path/path_settings.hpp"
#include "../../scene/scene_view.hpp"

namespace realcam {

/// Counters that all launches since the last clear_counts add to, in the GPU's memory.
struct RenderCounts {
    unsigned long long sampled_rays, passed_rays, scene_rays;  ///< see RenderStats
    unsigned long long lens_clocks, scene_clocks, all_clocks;  ///< clock cycles by RenderStage and of all stages,
                                                               ///< summed over a sample of the threads

    RenderCounts& operator+=(const RenderCounts& other) {
        sampled_rays += other.sampled_rays;
        passed_rays += other.passed_rays;
        scene_rays += other.scene_rays;
        lens_clocks += other.lens_clocks;
        scene_clocks += other.scene_clocks;
        all_clocks += other.all_clocks;
        return *this;
    }
    RenderCounts operator-(const RenderCounts& other) const {
        return {sampled_rays - other.sampled_rays, passed_rays - other.passed_rays,   scene_rays - other.scene_rays,
                lens_clocks - other.lens_clocks,   scene_clocks - other.scene_clocks, all_clocks - other.all_clocks};
    }
};

/// Parameters of a launch of the render kernel: scene, camera, and a range of samples of the pixels of some rows. All
/// pointers are device pointers.
struct RenderJob {
    SceneView scene;
    SceneBvhView bvh;
    CameraView camera;
    PixelSum* sums;  ///< for the rows of the job, row by row; results are added
    RenderCounts* counts;
    const volatile int* stop;  ///< if the value is not 0, no thread starts another sample
    PathSettings path;
    std::uint32_t seed, first_sample, sample_count;
    /// PixelCounts for the rows of the job: `counts` and `taken`. Null: all pixels take sample_count.
    const std::uint32_t* pixel_counts;
    std::uint32_t pixels_taken;
    int first_row, row_count;  ///< rows of the picture
    bool adds_squares, adds_half, adds_excess;  ///< at most one is true: the use of PixelSum::auxiliary
};

/// Throws UnsupportedGpu if the current device cannot run this build's code.
void check_render_code();

/// Launches a job asynchronously. `pixels`: number of pixels by which the number of threads per pixel is chosen. That
/// is the number of the job's pixels, or of the film's if the order of summation must be that of a job over the whole
/// film. Throws DeviceError.
void launch_render(const RenderJob& job, std::int64_t pixels, cudaStream_t stream);

// The next functions launch kernels asynchronously. All arrays are in the GPU's memory. They throw DeviceError.

/// Develops a film to exposure (3 per pixel, lux seconds) and depth (metres).
void launch_develop(const FilmView& film, double exposure_time_s, float* exposure, float* depth, cudaStream_t stream);

/// Develops a film to 8-bit sRGB (3 per pixel).
void launch_develop_codes(const FilmView& film, double exposure_time_s, double iso, ToneCurve curve,
                          std::uint8_t* codes, cudaStream_t stream);

/// Writes the number of samples of each pixel.
void launch_count(const PixelSum* sums, std::int64_t pixels, std::int64_t* counts, cudaStream_t stream);

/// Adds the sums of another film to those of a film, for `pixels` pixels.
void launch_merge(PixelSum* sums, const PixelSum* other, std::int64_t pixels, cudaStream_t stream);

/// Render kernel; the int is the number of threads per pixel.
using RenderKernel = void (*)(RenderJob, int);

/// Returns the kernel for a lens kind, a scene kind and a set of effects, given by its index in kCompiledEffects.
/// `instanced`: true if the scene has instances. `halves`: true if the kernel sums dual-pixel halves.
template <LensKind lens_kind, SceneKind scene_kind, int effects, bool halves>
RenderKernel render_kernel_of(bool instanced);

}  // namespace realcam
