#include "kernels.hpp"

#include <time.h>

#include "../optics/lens_entry.hpp"
#include "../render/pixel_sum.hpp"
#include "packet_scene.hpp"

// Built once for each instruction set, see cmake/RealcamInstructionSets.cmake.

namespace REALCAM_NAMESPACE {
namespace {

constexpr int kLanes = 256;

double now() {
    timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct StageClock {
    double seconds[3] = {0, 0, 0};
    double since = now();
    RenderStage stage = RenderStage::other;

    void enter(RenderStage next) {
        const double time = now();
        seconds[static_cast<int>(stage)] += time - since;
        since = time;
        stage = next;
    }
};

/// Small squares of pixels one after the other: neighbours in a packet see the same part of the scene.
struct PixelOrder {
    static constexpr int kSide = 4;
    int width, height;

    int count() const { return ((width + kSide - 1) / kSide) * ((height + kSide - 1) / kSide) * kSide * kSide; }
    void at(int index, int& x, int& y) const {
        const int square = index / (kSide * kSide), inside = index % (kSide * kSide);
        const int squares = (width + kSide - 1) / kSide;
        x = square % squares * kSide + inside % kSide;
        y = square / squares * kSide + inside / kSide;
    }
};

void render_tile(realcam_tile* tile) {
    const SceneView view = *static_cast<const SceneView*>(tile->scene_view);
    const CameraView camera = *static_cast<const CameraView*>(tile->camera_view);
    const PixelOrder order{tile->width, tile->height};
    SampleBlock<kLanes> block;
    SampleResults<kLanes> results;
    PixelSum* target[kLanes];
    auto* const sums = static_cast<PixelSum*>(tile->sums);
    StageClock clock;
    PacketScene scene{static_cast<RTCScene>(tile->embree_scene), RayOrder::coherent, 0};
    const int pixels = order.count();
    int pixel = 0;
    std::uint32_t sample = 0;
    while (pixel < pixels) {
        int lanes = 0;
        while (lanes < kLanes && pixel < pixels) {
            int x, y;
            order.at(pixel, x, y);
            const bool inside = x < tile->width && y < tile->height;
            const std::uint32_t left = inside ? tile->sample_count - sample : 0;
            const int take = static_cast<int>(left) < kLanes - lanes ? static_cast<int>(left) : kLanes - lanes;
            if (take > 0) {
                const std::uint32_t stream = pixel_stream((tile->y + y) * camera.width + tile->x + x, tile->seed);
                for (int k = 0; k < take; ++k) {
                    block.column[lanes + k] = tile->x + x;
                    block.row[lanes + k] = tile->y + y;
                    block.used[lanes + k] = 1;
                    block.stream[lanes + k] = stream;
                    block.sample[lanes + k] = tile->first_sample + sample + static_cast<std::uint32_t>(k);
                    target[lanes + k] = sums + y * tile->width + x;
                }
                lanes += take;
                sample += static_cast<std::uint32_t>(take);
            }
            if (!inside || sample == tile->sample_count) {
                ++pixel;
                sample = 0;
            }
        }
        for (int k = lanes; k < kLanes; ++k) {
            block.column[k] = block.row[k] = block.used[k] = 0;
            block.stream[k] = block.sample[k] = 0;
        }
        scene.order = RayOrder::coherent;
        render_samples(view, camera, tile->max_bounces, block, scene, clock, results);
        for (int k = 0; k < lanes; ++k) {
            target[k]->add(results, k);
            tile->sampled_rays += static_cast<std::uint64_t>(results.sampled[k]);
            tile->passed_rays += static_cast<std::uint64_t>(results.passed[k]);
        }
    }
    clock.enter(RenderStage::other);
    tile->lens_seconds += clock.seconds[static_cast<int>(RenderStage::lens)];
    tile->scene_seconds += clock.seconds[static_cast<int>(RenderStage::scene)];
    tile->other_seconds += clock.seconds[static_cast<int>(RenderStage::other)];
    tile->scene_rays += scene.rays_traced;
}

void generate_rays_of(const realcam_ray_request* request) {
    const CameraView camera = *static_cast<const CameraView*>(request->camera_view);
    SampleBlock<kLanes> block;
    CameraRays<kLanes> rays;
    const std::int64_t count = static_cast<std::int64_t>(request->pixel_count) * request->sample_count;
    for (std::int64_t first = 0; first < count; first += kLanes) {
        const int used = static_cast<int>(count - first < kLanes ? count - first : kLanes);
        for (int k = 0; k < kLanes; ++k) {
            const std::int64_t ray = first + (k < used ? k : 0);
            const auto pixel = static_cast<std::int32_t>(request->first_pixel + ray / request->sample_count);
            block.column[k] = pixel % camera.width;
            block.row[k] = pixel / camera.width;
            block.used[k] = k < used;
            block.stream[k] = pixel_stream(pixel, request->seed);
            block.sample[k] = static_cast<std::uint32_t>(ray % request->sample_count);
        }
        generate_rays(camera, block, rays);
        for (int k = 0; k < used; ++k) {
            const Vec3f o = rays.origin[k], d = rays.direction[k];
            float* out_origin = request->origins + 3 * (first + k);
            float* out_direction = request->directions + 3 * (first + k);
            out_origin[0] = o.x, out_origin[1] = o.y, out_origin[2] = o.z;
            out_direction[0] = d.x, out_direction[1] = d.y, out_direction[2] = d.z;
            request->weights[first + k] = rays.passed[k] ? rays.weight[k] : 0.0f;
        }
    }
}

template <class T>
void trace_recorded(const realcam_trace* request) {
    constexpr int kBlock = 64;
    const LensView<T> lens = *static_cast<const LensView<T>*>(request->lens_view);
    LensRays<T, kBlock> rays;
    PathRecord<T, kBlock> record;
    double path_to_entry[kBlock];
    for (std::int64_t first = 0; first < request->count; first += kBlock) {
        const int used = static_cast<int>(request->count - first < kBlock ? request->count - first : kBlock);
        for (int k = 0; k < kBlock; ++k) {
            const std::int64_t ray = first + (k < used ? k : 0);
            const double* o = request->origins + 3 * ray;
            const double* d = request->directions + 3 * ray;
            const LensEntry entry = enter_lens({o[0], o[1], o[2] - request->entry_position}, {d[0], d[1], d[2]},
                                               request->entry_index, request->entry_reach);
            rays.origin.set(k, static_cast<Vec3<T>>(entry.origin));
            rays.direction.set(k, static_cast<Vec3<T>>(entry.direction));
            rays.status[k] = static_cast<int>(entry.status);
            path_to_entry[k] = entry.optical_path;
            record.optical_path[k] = 0;
            record.surface_index[k] = -1;
        }
        trace_lens(lens, rays, record);
        for (int k = 0; k < used; ++k) {
            double* o = request->out_origins + 3 * (first + k);
            double* d = request->out_directions + 3 * (first + k);
            const bool bad = rays.status[k] == static_cast<int>(RayStatus::bad_input);
            o[0] = rays.origin.x[k], o[1] = rays.origin.y[k];
            o[2] = bad ? 0.0 : static_cast<double>(rays.origin.z[k]) + request->exit_position;
            const Vec3d optical = static_cast<Vec3d>(rays.direction[k]);
            const double size = length(optical), unit = size > 0 ? 1 / size : 0.0;
            d[0] = unit * optical.x, d[1] = unit * optical.y, d[2] = unit * optical.z;
            request->optical_path[first + k] = path_to_entry[k] + static_cast<double>(record.optical_path[k]);
            request->status[first + k] = rays.status[k];
            request->surface_index[first + k] = record.surface_index[k];
        }
    }
}

void trace_block(const void* lens_view, void* rays) {
    trace_lens(*static_cast<const LensView<float>*>(lens_view), *static_cast<LensRays<float, kLanes>*>(rays));
}

}  // namespace
}  // namespace REALCAM_NAMESPACE

#define REALCAM_JOIN2(a, b) a##b
#define REALCAM_JOIN(a, b) REALCAM_JOIN2(a, b)
#define REALCAM_TEXT2(a) #a
#define REALCAM_TEXT(a) REALCAM_TEXT2(a)

extern "C" const realcam_kernels REALCAM_JOIN(realcam_kernels_, REALCAM_ISA);
extern "C" const realcam_kernels REALCAM_JOIN(realcam_kernels_, REALCAM_ISA) = {
    REALCAM_TEXT(REALCAM_ISA),       realcam::render_tile,          realcam::generate_rays_of, realcam::trace_block,
    realcam::trace_recorded<double>, realcam::trace_recorded<float>};
