#pragma once
#include <cuda_runtime.h>

#include <cstdint>

#include "../../bvh/wide_bvh.hpp"
#include "../../render/gradients/filtered_film.hpp"
#include "../../render/gradients/gradient_film.hpp"
#include "../../render/path/path_settings.hpp"
#include "../../scene/scene_view.hpp"

namespace realcam {

/// Scene and camera of a picture whose derivatives are taken. All pointers are device pointers.
struct GradientJob {
    SceneView scene;
    SceneBvhView bvh;
    CameraView camera;  ///< with the extended film
    PathSettings path;
    GradientFilm film;
    OutlineLens outline;
    TangentLens tangents;  ///< without freeforms
    const std::uint32_t* used_numbers;  ///< TangentPath::numbers_in_use
    int sum_count;  ///< number of sums of each warp: those of the film's frame, of the used numbers of all surfaces, of
                    ///< the pose, of the stop, and of the rims
};

/// Range of the samples of all pixels of the extended film, row by row, with `spp` samples each.
struct GradientPart {
    std::uint32_t seed;
    int spp;
    bool pairs;  ///< see GradientSamples
    std::int64_t first;
    int count;
};

/// Ray of the scene that lands on the film, or that grazes a rim, with the light that it brings.
struct GradientRay {
    Vec3f origin, direction;  ///< in render space
    Vec2f film, cosines;  ///< film point, mm, and optical direction cosines there; only for rays that land on the film
    Vec2f pixel;  ///< film point, in pixels of the picture
    float time, weight;  ///< see CameraRays; the weight is 0 if there is no ray
    float variable, cell_position;  ///< of its wavelength, if the camera has dispersion
    Color light;  ///< weight times radiance
};

/// Point of the pupil's outline.
struct OutlineEdge {
    DirectionLine line;
    OutlinePoint point;
    double weight;  ///< inverse density
};

/// Sums of a pixel of a filtered picture, in lux.
struct FilteredPixel {
    double sums[3];
};

/// Returns the number of warps of a launch over `count` samples. Each warp has sums of its own.
std::int64_t gradient_warps(int count);

// The functions below launch kernels asynchronously. All arrays are in the GPU's memory. They throw DeviceError.

/// Samples part.count rays on the film, with the light that they bring from a scene of radiance 1.
void launch_sample_film(const GradientJob& job, const GradientPart& part, GradientRay* rays, cudaStream_t stream);

/// Searches part.count lines for points of the outline, whose rays have the light of a scene of radiance 1. `edges`,
/// `rays`: kMostOutlinePoints x part.count. Adds the number of edges that no rim explains to `unexplained`.
void launch_find_outline(const GradientJob& job, const GradientPart& part, OutlineEdge* edges, GradientRay* rays,
                         unsigned long long* unexplained, cudaStream_t stream);

/// Traces the paths of rays, part.count or kMostOutlinePoints times as many, and sets their light.
void launch_trace_light(const GradientJob& job, const GradientPart& part, std::int64_t ray_count, GradientRay* rays,
                        cudaStream_t stream);

// If the adjoint film has a control variate, the sums of the pose are those of the light less the control variate.

/// Sets the sums of each warp (gradient_warps) to the interior term. `per_mm`: light's factor times pixels per mm.
void launch_film_tangents(const GradientJob& job, const AdjointFilm& adjoint, Vec2d per_mm, int count,
                          const GradientRay* rays, double* sums, cudaStream_t stream);

/// Sets the sums of each warp to the boundary term. `count`: all points; `scale`: the light's factor.
void launch_outline_tangents(const GradientJob& job, const AdjointFilm& adjoint, double scale, int count,
                             const OutlineEdge* edges, const GradientRay* rays, double* sums, cudaStream_t stream);

/// Adds the sums of `warps` warps to `totals`, in their order.
void launch_add_sums(int sum_count, std::int64_t warps, const double* sums, double* totals, cudaStream_t stream);

/// Adds the light of rays to the pixels of a picture.
void launch_add_filtered(const GradientJob& job, PixelFilter filter, const GradientPart& part, const GradientRay* rays,
                         FilteredPixel* picture, cudaStream_t stream);

}  // namespace realcam
