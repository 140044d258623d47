#pragma once
#include <cuda_runtime.h>

#include <cstdint>

#include "../bvh/wide_bvh.hpp"
#include "../camera/camera_view.hpp"
#include "../render/film_view.hpp"
#include "../render/kind_of.hpp"
#include "../render/path_settings.hpp"
#include "../render/pixel_sum.hpp"
#include "../scene/scene_view.hpp"

namespace realcam {

/// What the threads of all launches have counted.
struct RenderCounts {
    unsigned long long sampled_rays, passed_rays, scene_rays;
    unsigned long long lens_clocks, scene_clocks, all_clocks;  ///< of the threads that counted them

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

/// One launch: some samples of some rows of pixels. All pointers are the device's.
struct RenderJob {
    SceneView scene;
    SceneBvhView bvh;
    CameraView camera;
    PixelSum* sums;  ///< of the rows of the job's band, row by row; added to
    RenderCounts* counts;
    const volatile int* stop;  ///< not 0: no thread begins another sample
    PathSettings path;
    std::uint32_t seed, first_sample, sample_count;
    const std::uint32_t* of_pixels;  ///< how many of them single pixels of the band take, after pixels_taken; none: all
    std::uint32_t pixels_taken;
    int first_row, row_count;  ///< of the picture
    bool adds_squares, adds_half, balances;  ///< PixelSum::besides, too, for one of them
};

/// Throws UnsupportedGpu where the current device cannot run this build's code.
void check_render_code();

/// Starts a job. `pixels`: of the job, or of the film where pixels are to be summed as in a job of all of it. Throws
/// DeviceError.
void launch_render(const RenderJob& job, std::int64_t pixels, cudaStream_t stream);

/// A film as exposure (3 per pixel, lux seconds) and depth (metres).
void launch_develop(const FilmView& film, double exposure_time_s, float* exposure, float* depth, cudaStream_t stream);

/// The same as 8-bit sRGB (3 per pixel).
void launch_develop_codes(const FilmView& film, double exposure_time_s, double iso, ToneCurve curve,
                          std::uint8_t* codes, cudaStream_t stream);

/// The number of samples of each pixel.
void launch_count(const PixelSum* sums, std::int64_t pixels, std::int64_t* counts, cudaStream_t stream);

/// sums += other, for each of `pixels`.
void launch_merge(PixelSum* sums, const PixelSum* other, std::int64_t pixels, cudaStream_t stream);

}  // namespace realcam
