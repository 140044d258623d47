#pragma once
#include <cstdint>
#include <vector>

// Interface of the code that is built once for each instruction set. Only plain C functions on plain data cross it: the
// core's types have the same layout on both sides, but lie in different namespaces, so that they are passed as untyped
// pointers. The comment of each pointer names its type.

extern "C" {

// Rectangle of pixels to be rendered on one thread, and a range of their samples.
struct realcam_tile {
    const void* scene_view;  // SceneView
    const void* camera_view;  // CameraView
    void* embree_scene;  // RTCScene
    int x, y, width, height;  // first column and row on the film, and size, in pixels
    std::uint32_t first_sample, sample_count, seed;
    const std::uint32_t* counts;  // samples per pixel, row by row, from first_sample on; null: all samples
    const void* path_settings;  // PathSettings
    int (*stopped)(const void* stop);  // called before each block of samples; if true, the remaining ones are skipped
    const void* stop;  // argument of `stopped`
    void* sums;  // PixelSum, LayerSum or PixelCentreSurface per pixel, row by row; sums are accumulated
    int adds_squares, adds_half, adds_excess;  // at most one is true: the use of PixelSum::auxiliary
    int shares;  // true if pixels share samples (SampleSharing); all sums are then invalid if the tile was stopped
    double lens_seconds, scene_seconds, other_seconds;  // results: as in RenderStats, incremented
    std::uint64_t sampled_rays, passed_rays, scene_rays;
};

// Range of blocks of splatted samples (GhostBlocks), to be taken on one thread.
struct realcam_ghosts {
    const void* scene_view;  // SceneView
    const void* camera_view;  // CameraView
    const void* ghost_view;  // GhostView
    void* embree_scene;  // RTCScene
    std::uint64_t first_block, block_count;
    std::uint32_t seed;
    const void* path_settings;  // PathSettings
    double units_per_lux;  // unit of GhostSum
    int (*stopped)(const void* stop);  // called before each block; if true, the remaining ones are skipped
    const void* stop;  // argument of `stopped`
    void* sums;  // GhostSum of all pixels, film by film; accumulated, also by other threads
    int films;  // 1, or 2: one for blocks with even and one for blocks with odd indices
    std::uint64_t blocks_done[2], rays;  // results: blocks per film, and rays traced in the scene; incremented
};

// Block of 256 samples of PictureGradient.
struct realcam_gradient_block {
    const void* scene_view;  // SceneView
    const void* camera_view;  // CameraView
    void* embree_scene;  // RTCScene
    const void* path_settings;  // PathSettings
    const void* block;  // SampleBlock<256>
    void* film;  // result of sample_film: FilmSamples<256>
    const void* rays;  // CameraRays<256>
    const void* time;  // Lanes<float, 256>: fractions of the exposure
    void* results;  // result of trace_radiance: PathResults<256>
};

// Kernels for one instruction set.
struct realcam_kernels {
    const char* instruction_set;  // v2, v3, v4 or native (x86-64 levels)
    void (*render_tile)(realcam_tile*);  // adds to PixelSum
    void (*trace_layers)(realcam_tile*);  // adds to LayerSum; same samples as render_tile
    void (*trace_pixel_centres)(realcam_tile*);  // writes PixelCentreSurface; one sample per pixel
    void (*splat_ghosts)(realcam_ghosts*);  // adds to GhostSum
    void (*generate_rays)(const void* request);  // RayRequest
    void (*trace_block)(const void* lens_view, void* rays);  // LensView<float>, LensRays<float, 256>
    void (*trace_f64)(const void* request);  // TraceRequest<double>
    void (*trace_f32)(const void* request);  // TraceRequest<float>
    void (*expose_sensor)(const void* request);  // SensorRequest
    void (*film_points_f32)(void* request);  // FilmPointsRequest<float>
    void (*film_points_f64)(void* request);  // FilmPointsRequest<double>
    void (*aim_rays)(const void* request);  // AimRequest
    void (*sample_film)(const realcam_gradient_block*);
    void (*trace_radiance)(const realcam_gradient_block*);
};
}

namespace realcam {

/// Returns the kernels for the widest instruction set that was built and that this machine has. The environment
/// variable REALCAM_INSTRUCTION_SET (v2, v3, v4) selects a narrower one. Throws DeviceError if the machine has none of
/// those that were built.
const realcam_kernels& kernels();

/// Returns all kernels that were built and that this machine can run, the narrowest instruction set first.
std::vector<const realcam_kernels*> available_kernels();

}  // namespace realcam
