#include "lens_rays.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "../camera/camera_setup.hpp"
#include "../camera/ray_request.hpp"
#include "../optics/analysis/aim_request.hpp"
#include "../optics/pupil/bundle_quadrature.hpp"
#include "kernels.hpp"

namespace realcam {
namespace {

constexpr std::int64_t kChunk = 4096;  ///< rays that one task traces
/// Rays between two calls of KeepGoing, some 0.1 s.
constexpr std::int64_t kRaysBetweenCalls = 1 << 20;

/// Calls f(begin, end) for parts of [from, to), on all threads. `grain`: approximate size of a part.
template <class I, class F>
void in_parallel(I from, I to, I grain, F&& f) {
    // Uses the floating-point settings of the calling thread. Otherwise they would be those of whoever used this
    // thread's arena first, such as Embree, which flushes denormal numbers to zero while it builds a scene.
    tbb::task_group_context context(tbb::task_group_context::bound, tbb::task_group_context::fp_settings);
    tbb::parallel_for(
        tbb::blocked_range<I>(from, to, grain), [&](const auto& range) { f(range.begin(), range.end()); }, context);
}

/// in_parallel with parts of kChunk.
template <class F>
void in_chunks(std::int64_t from, std::int64_t to, F&& f) {
    in_parallel(from, to, kChunk, f);
}

/// Traces all rays of a request with a kernel. Throws Cancelled.
template <class T>
void trace_with(const TraceRequest<T>& all, void (*kernel)(const void*), const KeepGoing& keep_going) {
    const auto trace = [&](std::int64_t first, std::int64_t last) {
        TraceRequest<T> request = all;
        request.count = last - first;
        request.origins += 3 * first;
        request.directions += 3 * first;
        request.out_origins += 3 * first;
        request.out_directions += 3 * first;
        request.optical_path += first;
        request.status += first;
        request.surface_index += first;
        kernel(&request);
    };
    for (std::int64_t block = 0; block < all.count; block += kRaysBetweenCalls) {
        if (keep_going && !keep_going()) throw Cancelled();
        in_chunks(block, std::min(block + kRaysBetweenCalls, all.count), trace);
    }
}

/// find_film_points in the precision T, with a kernel for it. `lit`: entrance-pupil bounds of the bundle.
template <class T>
std::int64_t film_points_with(const LensSystem& lens, double wavelength_nm, const PointBundle& bundle,
                              const EntryRectangle& lit, EntryPattern pattern, std::int64_t count, double film_distance,
                              float* at, void (*kernel)(void*), const KeepGoing& keep_going) {
    const LensPath<T> path(lens, LightDirection::to_film, wavelength_nm, film_path_ends(lens, LightDirection::to_film));
    const auto two = [](Vec2<double> v) { return Vec2<T>{static_cast<T>(v.x), static_cast<T>(v.y)}; };
    FilmPointsRequest<T> request{path.view(),
                                 static_cast<Vec3<T>>(bundle.object.centre - Vec3d{0, 0, path.entry_position}),
                                 static_cast<Vec3<T>>(bundle.object.towards),
                                 static_cast<Vec3<T>>(bundle.object.across),
                                 static_cast<Vec3<T>>(bundle.object.upwards),
                                 two(lit.middle),
                                 two(lit.reach),
                                 static_cast<T>(bundle.object.inverse_distance),
                                 static_cast<T>(path.entry_index),
                                 static_cast<T>(film_distance),
                                 pattern,
                                 static_cast<std::int64_t>(std::ceil(std::sqrt(static_cast<double>(count)))),
                                 0,
                                 0,
                                 at,
                                 0};
    for (request.first = 0; request.first < count; request.first += kRaysBetweenCalls) {
        if (keep_going && !keep_going()) throw Cancelled();
        request.count = std::min(kRaysBetweenCalls, count - request.first);
        request.points = at + 2 * request.passed;
        kernel(&request);
    }
    return request.passed;
}

}  // namespace

std::int64_t find_film_points(const LensSystem& lens, double wavelength_nm, const PointBundle& bundle,
                              EntryPattern pattern, Precision precision, std::int64_t count, double film_distance,
                              float* at, const KeepGoing& keep_going) {
    const EntryRectangle lit = lit_rectangle(bundle, parallel_ray_loop(keep_going));
    if (precision == Precision::float64)
        return film_points_with<double>(lens, wavelength_nm, bundle, lit, pattern, count, film_distance, at,
                                        kernels().film_points_f64, keep_going);
    return film_points_with<float>(lens, wavelength_nm, bundle, lit, pattern, count, film_distance, at,
                                   kernels().film_points_f32, keep_going);
}

void trace_rays(const LensSystem& lens, LightDirection direction, double wavelength_nm, Precision precision,
                int surface_count, std::int64_t count, const double* origins, const double* directions,
                const TracedRays& out, const realcam_kernels* on, const KeepGoing& keep_going) {
    const realcam_kernels& chosen = on ? *on : kernels();
    if (precision == Precision::float64) {
        const TracePath<double> path(lens, direction, wavelength_nm, surface_count);
        trace_with(path.request(count, origins, directions, out), chosen.trace_f64, keep_going);
    } else {
        const TracePath<float> path(lens, direction, wavelength_nm, surface_count);
        trace_with(path.request(count, origins, directions, out), chosen.trace_f32, keep_going);
    }
}

void generate_camera_rays(const CameraSetup& setup, std::uint32_t spp, std::uint32_t seed, RayRange range,
                          const CameraRayOutput& out) {
    const Vec3d camera_position = setup.camera().pose.position_m;
    const TimeInterval exposure = setup.camera().exposure();
    const CameraView view = setup.view(camera_position, true);
    in_chunks(0, range.count, [&](std::int64_t begin, std::int64_t end) {
        const CameraRayOutput to = out.from(begin);
        std::vector<float> origins(static_cast<std::size_t>(3 * (end - begin)));
        std::vector<float> times(static_cast<std::size_t>(end - begin));
        const RayRequest request{view,
                                 {range.first + begin, end - begin},
                                 spp,
                                 seed,
                                 origins.data(),
                                 to.directions,
                                 to.weights,
                                 times.data(),
                                 to.wavelengths_nm,
                                 static_cast<float>(setup.camera().lens.wavelength_nm)};
        kernels().generate_rays(&request);
        // The camera's position is added in double: far from the scene's origin, float could not resolve the pupil.
        for (std::int64_t i = 0; i < end - begin; ++i) {
            const float* from = origins.data() + 3 * i;
            to.origins_m[3 * i] = camera_position.x + static_cast<double>(from[0]);
            to.origins_m[3 * i + 1] = camera_position.y + static_cast<double>(from[1]);
            to.origins_m[3 * i + 2] = camera_position.z + static_cast<double>(from[2]);
            to.times_s[i] = exposure.at(static_cast<double>(times[static_cast<std::size_t>(i)]));
        }
    });
}

RayLoop parallel_ray_loop(KeepGoing keep_going, std::size_t grain) {
    return {
        std::move(keep_going),
        [grain](std::size_t first, std::size_t last, const RayTask& task) { in_parallel(first, last, grain, task); },
        [](const AimRequest& request) { kernels().aim_rays(&request); }};
}

PupilTracer fast_pupil_tracer() {
    const auto trace = kernels().trace_block;
    return {[trace](const LensView<float>& view, PupilTracer::Rays& rays) { trace(&view, &rays); },
            [](int count, const PupilTracer::Task& task) {
                tbb::parallel_for(
                    tbb::blocked_range<int>(0, count, 1),
                    [&](const tbb::blocked_range<int>& range) {
                        for (int i = range.begin(); i < range.end(); ++i) task(i);
                    },
                    tbb::simple_partitioner());
            }};
}

}  // namespace realcam
