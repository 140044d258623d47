#include "kernels.hpp"

#include <time.h>

#include <iterator>
#include <utility>

#include "../camera/ray_request.hpp"
#include "../camera/sensor/sensor_request.hpp"
#include "../optics/analysis/aim_request.hpp"
#include "../optics/analysis/film_points_request.hpp"
#include "../optics/trace/trace_request.hpp"
#include "../render/film/pixel_sum.hpp"
#include "../render/ghosts/gather_ghosts.hpp"
#include "../render/ghosts/ghost_film.hpp"
#include "../render/gradients/film_radiance.hpp"
#include "../render/layers/trace_layers.hpp"
#include "../render/lights/trace_lights.hpp"
#include "../render/path/path_settings.hpp"
#include "../render/path/render_samples.hpp"
#include "packet_scene.hpp"

// The CPU's kernels: loops over samples and rays in blocks of lanes. Built once for each instruction set, see
// cmake/RealcamInstructionSets.cmake.

namespace REALCAM_NAMESPACE {
namespace {

constexpr int kLanes = 256;  ///< samples per block

/// Returns the time in seconds.
double now() {
    timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Probe of advance_paths that measures the seconds of each stage.
struct StageClock {
    double seconds[3] = {0, 0, 0};  ///< by RenderStage
    double since = now();           ///< begin of the current stage
    RenderStage stage = RenderStage::other;

    /// Begins a stage.
    void enter(RenderStage next) {
        const double time = now();
        seconds[static_cast<int>(stage)] += time - since;
        since = time;
        stage = next;
    }
};

/// Order of a tile's pixels in small squares, so that the rays of a packet hit the same part of the scene.
struct PixelOrder {
    static constexpr int kSide = 4;
    int width, height;  ///< size of the tile

    /// Number of indices; includes those of pixels outside the tile, which complete its last squares.
    int count() const { return ((width + kSide - 1) / kSide) * ((height + kSide - 1) / kSide) * kSide * kSide; }
    /// Returns the pixel of an index in x and y.
    void at(int index, int& x, int& y) const {
        const int square = index / (kSide * kSide), inside = index % (kSide * kSide);
        const int squares = (width + kSide - 1) / kSide;
        x = square % squares * kSide + inside % kSide;
        y = square / squares * kSide + inside / kSide;
    }
};

/// Calls f(block, lanes, pixel_index) for all samples of a tile, kLanes at a time. Only the first `lanes` lanes of a
/// block are in use; `pixel_index` holds for each of them the index of its pixel in the tile's sums.
template <class F>
void for_blocks_of(const realcam_tile& tile, int film_width, F&& f) {
    const PixelOrder order{tile.width, tile.height};
    SampleBlock<kLanes> block;
    int pixel_index[kLanes];
    const int pixels = order.count();
    int pixel = 0;
    std::uint32_t sample = 0;
    while (pixel < pixels && !tile.stopped(tile.stop)) {
        int lanes = 0;
        while (lanes < kLanes && pixel < pixels) {
            int x, y;
            order.at(pixel, x, y);
            const bool inside = x < tile.width && y < tile.height;
            const std::uint32_t count = !inside ? 0 : tile.counts ? tile.counts[y * tile.width + x] : tile.sample_count;
            const std::uint32_t left = count - sample;
            const int added = static_cast<int>(left) < kLanes - lanes ? static_cast<int>(left) : kLanes - lanes;
            if (added > 0) {
                const std::uint32_t stream = pixel_stream((tile.y + y) * film_width + tile.x + x, tile.seed);
                for (int k = 0; k < added; ++k) {
                    block.column[lanes + k] = tile.x + x;
                    block.row[lanes + k] = tile.y + y;
                    block.used[lanes + k] = 1;
                    block.stream[lanes + k] = stream;
                    block.sample[lanes + k] = tile.first_sample + sample + static_cast<std::uint32_t>(k);
                    pixel_index[lanes + k] = y * tile.width + x;
                }
                lanes += added;
                sample += static_cast<std::uint32_t>(added);
            }
            if (sample == count) {
                ++pixel;
                sample = 0;
            }
        }
        for (int k = lanes; k < kLanes; ++k) {
            block.column[k] = block.row[k] = block.used[k] = 0;
            block.stream[k] = block.sample[k] = 0;
        }
        f(block, lanes, pixel_index);
    }
}

/// Returns the scene of a tile, for camera rays first.
template <SceneKind scene_kind>
PacketScene<scene_kind> packet_scene_of(const realcam_tile& tile, const SceneView& view) {
    return {static_cast<RTCScene>(tile.embree_scene), static_cast<std::uint32_t>(view.instance_count),
            RayOrder::coherent, 0};
}

/// Adds the sums for the dual-pixel layers. Out of line, because most pictures do not have these layers.
template <Effects effects>
[[gnu::noinline]] void add_halves(const CameraView& camera, const SampleBlock<kLanes>& block, int lanes,
                                  const int* pixel_index, const PathResults<kLanes>& results, PixelSum* sums) {
    Lanes<std::int32_t, kLanes> is_right;
    find_right_half<effects>(camera, block, is_right);
    for (int k = 0; k < lanes; ++k) sums[pixel_index[k]].add_half(results, k, is_right[k] != 0);
}

/// Adds the contributions of samples to pixels other than their own.
template <Effects effects>
void add_shared(const PathResultsWith<kLanes, effects>& results, int lanes, const int* pixel_index, PixelSum* sums) {
    for (int step = 0; step < kSharedWavelengths - 1; ++step)
        for (int k = 0; k < lanes; ++k)
            // An offset in the tile's sums, because SampleSharing was given the tile and its width (render_tile_of).
            if (const int away = results.shared.away[step][k]; away != 0) {
                sums[pixel_index[k] + away].add(results.shared.irradiance[step][k]);
                sums[pixel_index[k] + away].add_excess(results.shared.white[step][k]);
            }
}

/// Renders a tile with code that is compiled for these kinds and effects.
template <LensKind lens_kind, SceneKind scene_kind, Effects effects>
void render_tile_of(realcam_tile* tile) {
    const SceneView view = *static_cast<const SceneView*>(tile->scene_view);
    const PathSettings settings = *static_cast<const PathSettings*>(tile->path_settings);
    CameraView camera = *static_cast<const CameraView*>(tile->camera_view);
    if (tile->shares) camera.dispersion.sharing = {{tile->x, tile->y, tile->width, tile->height}, tile->width};
    PathResultsWith<kLanes, effects> results;
    auto* const sums = static_cast<PixelSum*>(tile->sums);
    StageClock clock;
    PacketScene<scene_kind> scene = packet_scene_of<scene_kind>(*tile, view);
    for_blocks_of(*tile, camera.width, [&](const SampleBlock<kLanes>& block, int lanes, const int* pixel_index) {
        scene.order = RayOrder::coherent;
        render_samples<lens_kind, scene_kind, effects>(view, camera, settings, block, scene, clock, results);
        for (int k = 0; k < lanes;) {
            const int pixel = pixel_index[k];
            PixelSum sum = sums[pixel];  // stays in registers while consecutive samples are in the same pixel
            for (; k < lanes && pixel_index[k] == pixel; ++k) sum.add(results, k);
            sums[pixel] = sum;
        }
        if constexpr (effects.share_pixels())
            if (tile->shares) add_shared(results, lanes, pixel_index, sums);
        if constexpr (effects.have_wavelengths())
            if (tile->adds_excess)
                for (int k = 0; k < lanes; ++k) sums[pixel_index[k]].add_excess(results.excess[k]);
        std::int32_t sampled = 0, passed = 0;
        for (int k = 0; k < lanes; ++k) {
            sampled += results.sampled[k];
            passed += results.passed[k];
        }
        tile->sampled_rays += static_cast<std::uint64_t>(sampled);
        tile->passed_rays += static_cast<std::uint64_t>(passed);
        if (tile->adds_squares)
            for (int k = 0; k < lanes; ++k) sums[pixel_index[k]].add_squares(results, k);
        if (tile->adds_half) add_halves<effects>(camera, block, lanes, pixel_index, results, sums);
    });
    clock.enter(RenderStage::other);
    tile->lens_seconds += clock.seconds[static_cast<int>(RenderStage::lens)];
    tile->scene_seconds += clock.seconds[static_cast<int>(RenderStage::scene)];
    tile->other_seconds += clock.seconds[static_cast<int>(RenderStage::other)];
    tile->scene_rays += scene.rays_traced;
}

/// Renders a tile with the code for these kinds. `effects_number`: index in kCompiledEffects.
template <int effects_number>
void render_tile_with(realcam_tile* tile, LensKind lens_kind, SceneKind scene_kind) {
    constexpr Effects effects = kCompiledEffects[effects_number];
    // Lenses without rotational symmetry have one kernel for all scenes: they are rare, and each kernel takes long to
    // compile.
    if (lens_kind == LensKind::any) return render_tile_of<LensKind::any, SceneKind::any, effects>(tile);
    switch (scene_kind) {
        case SceneKind::plain: return render_tile_of<LensKind::rotational, SceneKind::plain, effects>(tile);
        case SceneKind::opaque: return render_tile_of<LensKind::rotational, SceneKind::opaque, effects>(tile);
        case SceneKind::any: return render_tile_of<LensKind::rotational, SceneKind::any, effects>(tile);
    }
}

void render_tile(realcam_tile* tile) {
    const auto& scene = *static_cast<const SceneView*>(tile->scene_view);
    const auto& camera = *static_cast<const CameraView*>(tile->camera_view);
    // Calls the instance of render_tile_with whose template argument is the index of the camera's effects.
    const int effects_index = number_of(camera.effects);
    [&]<int... number>(std::integer_sequence<int, number...>) {
        (void)((number == effects_index &&
                (render_tile_with<number>(tile, kernel_lens_kind(camera), kernel_scene_kind(scene, camera)), true)) ||
               ...);
    }(std::make_integer_sequence<int, std::size(kCompiledEffects)>());
}

void trace_layers_of_tile(realcam_tile* tile) {
    const SceneView view = *static_cast<const SceneView*>(tile->scene_view);
    const CameraView camera = *static_cast<const CameraView*>(tile->camera_view);
    LayerResults<kLanes> results;
    auto* const sums = static_cast<LayerSum*>(tile->sums);
    auto scene = packet_scene_of<SceneKind::any>(*tile, view);
    for_blocks_of(*tile, camera.width, [&](const SampleBlock<kLanes>& block, int lanes, const int* pixel_index) {
        scene.order = RayOrder::coherent;
        trace_layers(view, camera, block, scene, results);
        for (int k = 0; k < lanes; ++k) sums[pixel_index[k]].add(results, k);
    });
}

void trace_pixel_centres_of_tile(realcam_tile* tile) {
    const SceneView view = *static_cast<const SceneView*>(tile->scene_view);
    const CameraView camera = *static_cast<const CameraView*>(tile->camera_view);
    PixelCentreSurface block_surfaces[kLanes];
    auto* const surfaces = static_cast<PixelCentreSurface*>(tile->sums);
    auto scene = packet_scene_of<SceneKind::any>(*tile, view);
    for_blocks_of(*tile, camera.width, [&](const SampleBlock<kLanes>& block, int lanes, const int* pixel_index) {
        scene.order = RayOrder::coherent;
        trace_pixel_centres(view, camera, block, scene, block_surfaces);
        for (int k = 0; k < lanes; ++k) surfaces[pixel_index[k]] = block_surfaces[k];
    });
}

/// Calls sample(view, camera, ghosts, range, first, scene, splat) for all samples of a job's blocks, kLanes at a time;
/// `first` is the index of the first of these samples in its block.
template <SceneKind scene_kind, class Sample>
void for_ghosts_of(realcam_ghosts* job, Sample&& sample) {
    const SceneView view = *static_cast<const SceneView*>(job->scene_view);
    const CameraView camera = *static_cast<const CameraView*>(job->camera_view);
    const GhostView ghosts = *static_cast<const GhostView*>(job->ghost_view);
    GhostSum* sums = nullptr;
    PacketScene<scene_kind> scene{static_cast<RTCScene>(job->embree_scene),
                                  static_cast<std::uint32_t>(view.instance_count), RayOrder::incoherent, 0};
    const auto splat = [&](std::int32_t pixel, Color lux, float dither) {
        const float channels[3] = {lux.r, lux.g, lux.b};
        for (int c = 0; c < 3; ++c)
            __atomic_fetch_add(&sums[pixel].units[c], ghost_units(channels[c], job->units_per_lux, dither),
                               __ATOMIC_RELAXED);
    };
    static_assert(kGhostBlock % kLanes == 0);
    for (std::uint64_t i = 0; i < job->block_count && !job->stopped(job->stop); ++i) {
        const GhostRange range{job->first_block + i, job->seed};
        const int film = film_of_block(range.first_block, job->films);
        sums = static_cast<GhostSum*>(job->sums) + std::int64_t{film} * camera.width * camera.height;
        for (std::uint32_t first = 0; first < kGhostBlock; first += kLanes)
            sample(view, camera, ghosts, range, first, scene, splat);
        ++job->blocks_done[film];
    }
    job->rays += scene.rays_traced;
}

// Take the samples of a job, for each kind of splatted light.

template <LensKind lens_kind, SceneKind scene_kind, bool has_wavelengths>
void splat_ghosts_with(realcam_ghosts* job) {
    for_ghosts_of<scene_kind>(
        job, [](auto&... arguments) { splat_ghosts<lens_kind, scene_kind, has_wavelengths, kLanes>(arguments...); });
}

template <LensKind lens_kind, SceneKind scene_kind, bool has_wavelengths>
void trace_lights_with(realcam_ghosts* job) {
    for_ghosts_of<scene_kind>(
        job, [](auto&... arguments) { trace_lights<lens_kind, scene_kind, has_wavelengths, kLanes>(arguments...); });
}

template <LensKind lens_kind, bool has_wavelengths>
void gather_ghosts_with(realcam_ghosts* job) {
    const PathSettings settings = *static_cast<const PathSettings*>(job->path_settings);
    for_ghosts_of<SceneKind::any>(job, [&](const auto& view, const auto& camera, const auto& ghosts, const auto& range,
                                           std::uint32_t first, auto& scene, const auto& splat) {
        gather_ghosts<lens_kind, SceneKind::any, has_wavelengths, kLanes>(view, camera, settings, ghosts, range, first,
                                                                          scene, splat);
    });
}

/// Takes samples of the kind of light that the job's GhostView selects.
template <bool has_wavelengths>
void take_splats_with(realcam_ghosts* job) {
    const auto& camera = *static_cast<const CameraView*>(job->camera_view);
    const bool is_plain =
        kernel_scene_kind(*static_cast<const SceneView*>(job->scene_view), camera) == SceneKind::plain;
    constexpr LensKind round = LensKind::rotational;
    switch (static_cast<const GhostView*>(job->ghost_view)->light) {
        case GhostLight::of_lights:
        case GhostLight::starbursts:
            if (needs_general_lens_code(camera))
                return splat_ghosts_with<LensKind::any, SceneKind::any, has_wavelengths>(job);
            return is_plain ? splat_ghosts_with<round, SceneKind::plain, has_wavelengths>(job)
                            : splat_ghosts_with<round, SceneKind::any, has_wavelengths>(job);
        case GhostLight::direct:
            if (needs_general_lens_code(camera))
                return trace_lights_with<LensKind::any, SceneKind::any, has_wavelengths>(job);
            return is_plain ? trace_lights_with<round, SceneKind::plain, has_wavelengths>(job)
                            : trace_lights_with<round, SceneKind::any, has_wavelengths>(job);
        case GhostLight::of_objects:
            return needs_general_lens_code(camera) ? gather_ghosts_with<LensKind::any, has_wavelengths>(job)
                                                   : gather_ghosts_with<round, has_wavelengths>(job);
    }
}

void take_splats(realcam_ghosts* job) {
    return static_cast<const GhostView*>(job->ghost_view)->effects.have_wavelengths() ? take_splats_with<true>(job)
                                                                                      : take_splats_with<false>(job);
}

void sample_film_of(const realcam_gradient_block* of) {
    const CameraView camera = *static_cast<const CameraView*>(of->camera_view);
    const auto& block = *static_cast<const SampleBlock<kLanes>*>(of->block);
    auto& film = *static_cast<FilmSamples<kLanes>*>(of->film);
    if (needs_general_lens_code(camera))
        sample_film<LensKind::any>(camera, block, film);
    else
        sample_film<LensKind::rotational>(camera, block, film);
}

template <SceneKind scene_kind>
void trace_radiance_with(const realcam_gradient_block* of) {
    const SceneView view = *static_cast<const SceneView*>(of->scene_view);
    const CameraView camera = *static_cast<const CameraView*>(of->camera_view);
    const PathSettings settings = *static_cast<const PathSettings*>(of->path_settings);
    PacketScene<scene_kind> scene{static_cast<RTCScene>(of->embree_scene),
                                  static_cast<std::uint32_t>(view.instance_count), RayOrder::coherent, 0};
    trace_radiance<scene_kind>(view, camera, settings, *static_cast<const SampleBlock<kLanes>*>(of->block),
                               *static_cast<const CameraRays<kLanes>*>(of->rays),
                               *static_cast<const Lanes<float, kLanes>*>(of->time), scene,
                               *static_cast<PathResults<kLanes>*>(of->results));
}

void trace_radiance_of(const realcam_gradient_block* of) {
    const auto& camera = *static_cast<const CameraView*>(of->camera_view);
    switch (kernel_scene_kind(*static_cast<const SceneView*>(of->scene_view), camera)) {
        case SceneKind::plain: return trace_radiance_with<SceneKind::plain>(of);
        case SceneKind::opaque: return trace_radiance_with<SceneKind::opaque>(of);
        case SceneKind::any: return trace_radiance_with<SceneKind::any>(of);
    }
}

// The functions of realcam_kernels for rays and sensors: they process a whole request in blocks.

void generate_all(const void* request) {
    const RayRequest rays = *static_cast<const RayRequest*>(request);
    for (std::int64_t first = 0; first < rays.count(); first += kLanes) {
        if (needs_general_lens_code(rays.camera))
            generate_rays_of<LensKind::any, kLanes>(rays, first);
        else
            generate_rays_of<LensKind::rotational, kLanes>(rays, first);
    }
}

template <class T>
void trace_all(const void* request) {
    constexpr int kBlock = 64;
    const TraceRequest<T> rays = *static_cast<const TraceRequest<T>*>(request);
    for (std::int64_t first = 0; first < rays.count; first += kBlock) trace_ray_block<kBlock>(rays, first);
}

void expose_sensor(const void* request) {
    expose_rows<kLanes>(*static_cast<const SensorRequest*>(request));
}

template <class T>
void film_points(void* request) {
    auto& points = *static_cast<FilmPointsRequest<T>*>(request);
    switch (points.lens.kind) {
        case LensKind::plain: return find_film_points<LensKind::plain, kLanes>(points);
        case LensKind::rotational: return find_film_points<LensKind::rotational, kLanes>(points);
        case LensKind::any: return find_film_points<LensKind::any, kLanes>(points);
    }
}

void aim_all(const void* request) {
    aim_rays<64>(*static_cast<const AimRequest*>(request));
}

void trace_block(const void* lens_view, void* rays) {
    trace_lens(*static_cast<const LensView<float>*>(lens_view), *static_cast<LensRays<float, kLanes>*>(rays));
}

}  // namespace
}  // namespace REALCAM_NAMESPACE

// The table of this instruction set's kernels is named realcam_kernels_v3, for example.
#define REALCAM_JOIN2(a, b) a##b
#define REALCAM_JOIN(a, b) REALCAM_JOIN2(a, b)
#define REALCAM_TEXT2(a) #a
#define REALCAM_TEXT(a) REALCAM_TEXT2(a)

extern "C" const realcam_kernels REALCAM_JOIN(realcam_kernels_, REALCAM_ISA);
extern "C" const realcam_kernels REALCAM_JOIN(realcam_kernels_, REALCAM_ISA) = {REALCAM_TEXT(REALCAM_ISA),
                                                                                realcam::render_tile,
                                                                                realcam::trace_layers_of_tile,
                                                                                realcam::trace_pixel_centres_of_tile,
                                                                                realcam::take_splats,
                                                                                realcam::generate_all,
                                                                                realcam::trace_block,
                                                                                realcam::trace_all<double>,
                                                                                realcam::trace_all<float>,
                                                                                realcam::expose_sensor,
                                                                                realcam::film_points<float>,
                                                                                realcam::film_points<double>,
                                                                                realcam::aim_all,
                                                                                realcam::sample_film_of,
                                                                                realcam::trace_radiance_of};
