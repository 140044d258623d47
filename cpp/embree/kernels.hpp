#pragma once
#include <cstdint>
#include <vector>

// What is built once for each instruction set. Only plain C functions on plain data cross this border: the core's
// types have the same layout on both sides, but other names, so they travel as untyped pointers.

extern "C" {

struct realcam_tile {
    const void* scene_view;   // SceneView
    const void* camera_view;  // CameraView
    void* embree_scene;       // RTCScene
    int x, y, width, height;  // pixels
    std::uint32_t first_sample, sample_count, seed;
    int max_bounces;
    void* sums;               // PixelSum of the tile, row by row; added to
    double lens_seconds, scene_seconds, other_seconds;
    std::uint64_t sampled_rays, passed_rays, scene_rays;
};

/// Rays for camera.generate_rays: arrays of pixel_count * sample_count entries, pixel by pixel.
struct realcam_ray_request {
    const void* camera_view;
    int first_pixel, pixel_count;
    std::uint32_t sample_count, seed;
    float *origins, *directions, *weights;  // 3, 3 and 1 per ray; weight 0: blocked
};

/// A trace with its record, one array for each quantity (double, or float for the f32 functions).
struct realcam_trace {
    const void* lens_view;
    double entry_position, exit_position;  // z of the vertices to which the first and the last step are relative
    double entry_index;       // of the medium from which the rays enter
    double entry_reach;       // how far from the first vertex an origin may lie
    const double *origins, *directions;     // count x 3, lens frame; directions of any length
    double *out_origins, *out_directions;   // count x 3, lens frame; unit directions
    double* optical_path;
    int *status, *surface_index;
    std::int64_t count;
};

struct realcam_kernels {
    const char* instruction_set;
    void (*render_tile)(realcam_tile*);
    void (*generate_rays)(const realcam_ray_request*);
    void (*trace_block)(const void* lens_view, void* rays);  // LensView<float>, LensRays<float, 256>
    void (*trace_f64)(const realcam_trace*);
    void (*trace_f32)(const realcam_trace*);
};
}

namespace realcam {

/// The widest instruction set that was built and that this machine has. The environment variable
/// REALCAM_INSTRUCTION_SET (v2, v3, v4) asks for a narrower one. Throws DeviceError where the machine has none.
const realcam_kernels& kernels();

/// All that were built and that this machine can run, the narrowest first.
std::vector<const realcam_kernels*> available_kernels();

}  // namespace realcam
