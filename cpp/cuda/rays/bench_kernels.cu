#include <algorithm>
#include <chrono>

#include "../../bvh/traverse_scene.hpp"
#include "../../camera/camera_setup.hpp"
#include "../../camera/models/generate_rays.hpp"
#include "../../render/session/progress.hpp"
#include "../../scene/geometry/surface_point.hpp"
#include "../../scene/materials/light_sample.hpp"
#include "../../scene/scene_checks.hpp"
#include "../device/current_device.hpp"
#include "../device/launch_grid.hpp"
#include "../session/device_scene.hpp"
#include "bench_kernels.hpp"

namespace realcam {
namespace {

constexpr float kImpossibleSum = 12345.678f;  ///< comparing with it keeps the compiler from removing the work
constexpr int kRounds = 5;  ///< number of launches; the fastest one counts

/// Ray of a benchmark: in the lens frame (mm) or in render space (m).
struct BenchRay {
    Vec3f origin, direction;

    /// False for a camera ray that does not pass the lens.
    __device__ bool exists() const { return dot(direction, direction) > 0; }
};

constexpr std::uint32_t kBounceSeed = 1;  ///< other than that of camera rays, 0

/// Returns the block with one sample of a pixel.
__device__ SampleBlock<1> block_of(const CameraView& camera, std::int32_t pixel, std::uint32_t sample) {
    SampleBlock<1> block;
    block.column[0] = pixel % camera.width;
    block.row[0] = pixel / camera.width;
    block.used[0] = 1;
    block.stream[0] = pixel_stream(pixel, 0);
    block.sample[0] = sample;
    return block;
}

/// Generates `samples` camera rays per thread, and counts those that pass the lens. `sink`: keeps the compiler from
/// removing the work.
template <LensKind lens_kind>
__global__ void generate(const __grid_constant__ CameraView camera, int samples, unsigned long long* passed,
                         float* sink) {
    const auto pixel = static_cast<std::int32_t>(thread_index());
    std::uint32_t count = 0;
    float sum = 0;
    for (int s = 0; s < samples && pixel < camera.width * camera.height; ++s) {
        CameraRays<1> rays;
        generate_rays<lens_kind>(camera, block_of(camera, pixel, static_cast<std::uint32_t>(s)), rays);
        count += static_cast<std::uint32_t>(rays.passed[0]);
        sum += rays.weight[0] + rays.origin.x[0] + rays.direction.x[0];
    }
    atomicAdd(passed, static_cast<unsigned long long>(count));
    if (sum == kImpossibleSum) *sink = sum;
}

/// Samples the rays that generate_rays traces through the lens.
__global__ void sample_lens_rays(const __grid_constant__ CameraView camera, BenchRay* rays) {
    const auto pixel = static_cast<std::int32_t>(thread_index());
    if (pixel >= camera.width * camera.height) return;
    const SampleBlock<1> block = block_of(camera, pixel, 0);
    const Vec2f film = film_point(camera, block.column[0], block.row[0], block.random(0, dimension::film));
    const Vec2f u = block.random(0, dimension::pupil);
    const FilmRaySample ray = sample_film_ray<LensKind::any>(camera, film, u);
    rays[pixel] = {ray.origin, ray.direction};
}

/// Traces each ray `repeats` times through the lens, slightly shifted each time.
template <LensKind lens_kind>
__global__ void trace(const __grid_constant__ CameraView camera, const BenchRay* rays, int repeats,
                      unsigned long long* passed, float* sink) {
    const auto pixel = static_cast<std::int32_t>(thread_index());
    if (pixel >= camera.width * camera.height) return;
    const BenchRay start = rays[pixel];
    std::uint32_t count = 0;
    float sum = 0;
    for (int i = 0; i < repeats; ++i) {
        LensRays<float, 1> inside;
        Vec3f origin = start.origin;
        origin.x += 1e-4f * static_cast<float>(i);
        inside.origin.set(0, origin);
        inside.direction.set(0, start.direction);
        inside.status[0] = 0;
        trace_lens<lens_kind>(camera.lens, inside);
        count += inside.status[0] == 0 ? 1u : 0u;
        sum += inside.origin.x[0] + inside.direction.x[0];
    }
    atomicAdd(passed, static_cast<unsigned long long>(count));
    if (sum == kImpossibleSum) *sink = sum;
}

/// Writes one camera ray per pixel, which does not exist if the lens stops it. `passed`: is increased by the number of
/// those that exist.
template <LensKind lens_kind>
__global__ void camera_rays(const __grid_constant__ CameraView camera, BenchRay* rays, unsigned long long* passed) {
    const auto pixel = static_cast<std::int32_t>(thread_index());
    if (pixel >= camera.width * camera.height) return;
    CameraRays<1> made;
    generate_rays<lens_kind>(camera, block_of(camera, pixel, 0), made);
    rays[pixel] = {made.origin[0], made.passed[0] ? made.direction[0] : Vec3f{0, 0, 0}};
    if (made.passed[0]) atomicAdd(passed, 1ull);
}

/// Replaces each ray by one that is scattered at its hit, cosine-weighted or uniformly over the hemisphere. Rays
/// without a hit stay unchanged.
template <bool instanced>
__global__ void bounce(const __grid_constant__ SceneView scene, SceneBvhView bvh, BenchRay* rays, int count,
                       bool uniform) {
    const int i = static_cast<int>(thread_index());
    if (i >= count || !rays[i].exists()) return;
    const BenchRay ray = rays[i];
    const Hit hit = closest_hit<instanced>(bvh, ray.origin, ray.direction, kFarAway);
    if (hit.triangle == kNoTriangle) return;
    const SurfacePoint point = surface_point<SceneKind::plain>(scene, hit, ray.origin, ray.direction, 0.0f);
    const Vec2f u = sample_2d(pixel_stream(i, kBounceSeed), 0, dimension::first_bounce);
    Vec3f direction = sample_cosine(point.geometric_normal, u);
    if (uniform) {
        direction = sample_sphere(u);
        if (dot(direction, point.geometric_normal) < 0) direction = -direction;
    }
    rays[i] = {point.position + point.self_offset * point.geometric_normal, direction};
}

/// Finds the closest hit of each ray.
template <bool instanced>
__global__ void hit_all(SceneBvhView bvh, const BenchRay* rays, int count, float* distances) {
    const int i = static_cast<int>(thread_index());
    if (i >= count || !rays[i].exists()) return;
    const BenchRay ray = rays[i];
    distances[i] = closest_hit<instanced>(bvh, ray.origin, ray.direction, kFarAway).distance;
}

/// Returns the work items per second, with `count` items per launch, in the best of kRounds launches.
template <class Launch>
double rate_of(cudaStream_t stream, double count, Launch&& launch) {
    CudaEvent start, end;
    double best = 0;
    for (int i = 0; i < kRounds; ++i) {
        start.record(stream);
        launch();
        check_cuda(cudaGetLastError(), "starting a benchmark");
        end.record(stream);
        end.wait();
        best = std::max(best, 1000 * count / end.ms_since(start));
    }
    return best;
}

}  // namespace

LensRayRates lens_ray_rates(int ordinal, const Camera& camera, PupilTracer tracer) {
    const CurrentDevice current(ordinal);
    CudaStream stream;
    DeviceArrays arrays;
    const CameraSetup setup(camera, std::move(tracer));
    const CameraView view =
        with_copied_arrays(setup.view(camera.pose.position_m),
                           [&](const auto* from, std::size_t count) { return arrays.copy(from, count, stream); });
    const int pixels = view.width * view.height;
    const LensKind kind = view.lens.kind;
    DeviceArray<unsigned long long> passed(1);
    DeviceArray<float> sink(1);
    DeviceArray<BenchRay> rays(static_cast<std::size_t>(pixels));
    passed.clear(stream);

    constexpr int kSamples = 64;  // rays per thread
    LensRayRates rates{};
    const double count = static_cast<double>(pixels) * kSamples;
    rates.generated = rate_of(stream, count, [&] {
        (kind == LensKind::plain        ? generate<LensKind::plain>
         : kind == LensKind::rotational ? generate<LensKind::rotational>
                                        : generate<LensKind::any>)<<<blocks_for(pixels), kBlockSize, 0, stream>>>(
            view, kSamples, passed.data(), sink.data());
    });
    unsigned long long total = 0;
    passed.download(&total, stream);
    stream.wait("running a benchmark");
    rates.passed = static_cast<double>(total) / (count * kRounds);
    sample_lens_rays<<<blocks_for(pixels), kBlockSize, 0, stream>>>(view, rays.data());
    rates.traced = rate_of(stream, count, [&] {
        (kind == LensKind::plain        ? trace<LensKind::plain>
         : kind == LensKind::rotational ? trace<LensKind::rotational>
                                        : trace<LensKind::any>)<<<blocks_for(pixels), kBlockSize, 0, stream>>>(
            view, rays.data(), kSamples, passed.data(), sink.data());
    });
    return rates;
}

HitRates hit_rates(int ordinal, const Assembly& scene, const Camera& camera, PupilTracer tracer) {
    SceneChecks().check(scene);
    const CurrentDevice current(ordinal);
    CudaStream stream;
    HitRates rates{};
    const RenderSpaceScene placed(scene, position_when_open(camera), camera.exposure());
    const auto building = std::chrono::steady_clock::now();
    const SceneBvh bvh = build_scene_bvh(placed);
    rates.build_seconds = seconds_since(building);
    const auto uploading = std::chrono::steady_clock::now();
    DeviceScene on_device;
    on_device.set(placed, bvh, stream);
    rates.upload_seconds = seconds_since(uploading);

    const CameraSetup setup(camera, std::move(tracer));
    DeviceArrays arrays;
    const CameraView view = with_copied_arrays(setup.view(placed.origin_m()), [&](const auto* from, std::size_t count) {
        return arrays.copy(from, count, stream);
    });
    const int pixels = view.width * view.height;
    const LensKind kind = view.lens.kind;
    const bool instanced = on_device.view().instance_count > 0;
    DeviceArray<BenchRay> rays(static_cast<std::size_t>(pixels));
    DeviceArray<float> distances(static_cast<std::size_t>(pixels));
    DeviceArray<unsigned long long> passed(1);
    unsigned long long ray_count = 0;
    const auto measure = [&] {
        return rate_of(stream, static_cast<double>(ray_count), [&] {
            (instanced ? hit_all<true> : hit_all<false>)<<<blocks_for(pixels), kBlockSize, 0, stream>>>(
                on_device.bvh(), rays.data(), pixels, distances.data());
        });
    };
    const auto shoot = [&] {
        passed.clear(stream);
        (kind == LensKind::plain        ? camera_rays<LensKind::plain>
         : kind == LensKind::rotational ? camera_rays<LensKind::rotational>
                                        : camera_rays<LensKind::any>)<<<blocks_for(pixels), kBlockSize, 0, stream>>>(
            view, rays.data(), passed.data());
        passed.download(&ray_count, stream);
        stream.wait("running a benchmark");
    };
    shoot();
    rates.camera_rays = measure();
    for (const bool uniform : {false, true}) {
        shoot();
        (instanced ? bounce<true> : bounce<false>)<<<blocks_for(pixels), kBlockSize, 0, stream>>>(
            on_device.view(), on_device.bvh(), rays.data(), pixels, uniform);
        (uniform ? rates.uniform_rays : rates.bounce_rays) = measure();
    }
    return rates;
}

}  // namespace realcam
