#include "gradient_kernels.hpp"

#include "../../render/gradients/film_radiance.hpp"
#include "../device/cuda_error.hpp"
#include "../device/launch_grid.hpp"
#include "bvh_scene.hpp"
#include "exact_sums.hpp"
#include "gradient_sums.hpp"

namespace realcam {
namespace {

/// Samples that a thread takes of one launch, one after the other, before its warp's sums are complete.
constexpr int kSamplesPerThread = 8;
constexpr int kSamplesPerWarp = kSamplesPerThread * kWarpSize;

// Blocks per multiprocessor: paths as in render_kernel_template.hpp; lenses in double precision with as many registers
// as hide the latency of that precision.
constexpr int kPathBlocks = 6, kLensBlocks = 4;

/// Returns the block of one sample of a part.
__device__ SampleBlock<1> block_at(const GradientJob& job, const GradientPart& part, std::int64_t index) {
    const std::int64_t sample = part.first + index, per_row = std::int64_t{job.film.extended_width()} * part.spp;
    SampleBlock<1> block;
    job.film.set_sample(block, 0, static_cast<int>(sample / per_row), sample % per_row, part.spp, part.seed);
    block.used[0] = 1;
    return block;
}

/// Stores a ray, without its light.
__device__ GradientRay ray_of(const GradientJob& job, const FilmSamples<1>& sample) {
    GradientRay ray{};
    ray.origin = sample.rays.origin[0], ray.direction = sample.rays.direction[0];
    ray.film = {sample.origin.x[0], sample.origin.y[0]}, ray.cosines = {sample.direction.x[0], sample.direction.y[0]};
    ray.pixel = job.film.in_picture(sample.pixel[0]);
    ray.time = sample.time[0];
    ray.weight = sample.rays.passed[0] ? sample.rays.weight[0] : 0.0f;
    ray.variable = sample.variable[0], ray.cell_position = sample.wavelengths.cell_position[0];
    ray.light = grey(ray.weight);
    return ray;
}

template <LensKind lens_kind>
__global__ void sample_film_of(const __grid_constant__ GradientJob job, const GradientPart part, GradientRay* rays) {
    const std::int64_t index = thread_index();
    if (index >= part.count) return;
    SampleBlock<1> block = block_at(job, part, index);
    FilmSamples<1> sample{};
    if (part.pairs) sample.mirrored[0] = pair_sample(block, 0);
    sample_film<lens_kind>(job.camera, block, sample);
    rays[index] = ray_of(job, sample);
}

template <SceneKind scene_kind, bool instanced>
__global__ void __launch_bounds__(kBlockSize, kPathBlocks)
    trace_light_of(const __grid_constant__ GradientJob job, const GradientPart part, std::int64_t count,
                   GradientRay* rays) {
    const std::int64_t index = thread_index();
    if (index >= count || !(rays[index].weight > 0.0f)) return;
    const GradientRay ray = rays[index];
    SampleBlock<1> block = block_at(job, part, index % part.count);
    if (part.pairs) pair_sample(block, 0);
    CameraRays<1> camera_rays;
    camera_rays.origin.set(0, ray.origin);
    camera_rays.direction.set(0, ray.direction);
    camera_rays.weight[0] = ray.weight;
    camera_rays.sampled[0] = camera_rays.passed[0] = 1;
    const Lanes<float, 1> time = {ray.time};
    BvhScene<scene_kind, instanced> scene{job.scene, job.bvh, 0};
    PathResults<1> results;
    trace_radiance<scene_kind>(job.scene, job.camera, job.path, block, camera_rays, time, scene, results);
    const Color light = results.irradiance[0];
    rays[index].light =
        job.camera.effects.dispersion ? film_color(job.camera.dispersion, ray.cell_position, light) : light;
}

/// True if the ray at t on a line passes the lens.
template <LensKind lens_kind>
__device__ __noinline__ bool passes_lens(const OutlineLens& lens, const RayWavelength& wavelength,
                                         const DirectionLine& line, double t) {
    const DirectionLine lines[1] = {line};
    const double at[1] = {t};
    TangentRays<1> rays = lens.start(lines, at);
    trace_lens<lens_kind>(lens.lens, static_cast<LensRays<double, 1>&>(rays), NoRecord{}, wavelength);
    return rays.status[0] == 0;
}

__device__ __noinline__ double clearance_of(const GradientJob& job, const RayWavelength& wavelength,
                                            const DirectionLine& line, double t) {
    const DirectionLine lines[1] = {line};
    const double at[1] = {t};
    double clearance[1];
    measure_clearance<LensKind::rotational>(
        job.outline, job.tangents, [&](int k) { return wavelength.from(k); }, lines, at, clearance);
    return clearance[0];
}

template <LensKind lens_kind>
__global__ void __launch_bounds__(kBlockSize, kLensBlocks)
    find_outline_of(const __grid_constant__ GradientJob job, const GradientPart part, OutlineEdge* edges,
                    GradientRay* rays, unsigned long long* unexplained) {
    const std::int64_t index = thread_index();
    if (index >= part.count) return;
    const SampleBlock<1> block = block_at(job, part, index);
    const PixelPoints<1> film(job.camera, block);
    const LaneNumbers<1> u(block, dimension::pupil);
    FilmSamples<1> sample{};
    if (job.camera.effects.dispersion) sample_wavelengths(job.camera, block, sample);
    const RayWavelength wavelength = wavelength_of(job, sample.variable[0]);
    const PupilLine from_centre = pupil_line(job.camera, film[0], u[0].x);
    const DirectionLine lines[1] = {from_centre.line};
    OutlinePoint points[kMostOutlinePoints][1];
    const int missed = find_outline(
        job.outline, lines, PupilLine::kEnd,
        [&](const DirectionLine(&on)[1], const double (&t)[1], int (&passes)[1]) {
            passes[0] = passes_lens<lens_kind>(job.outline, wavelength, on[0], t[0]);
        },
        [&](const DirectionLine(&on)[1], const double (&t)[1], double (&clearance)[1]) {
            clearance[0] = clearance_of(job, wavelength, on[0], t[0]);
        },
        [&](TangentRays<1>& traced, auto&& visit) {
            VisitCrossings<std::remove_reference_t<decltype(visit)>> crossings{visit, {}, {}};
            trace_tangents_to_scene(
                job.tangents, [&](int k) { return wavelength.from(k); }, traced, nullptr, nullptr, crossings);
        },
        points);
    if (missed > 0) atomicAdd(unexplained, static_cast<unsigned long long>(missed));
    const Vec2f offset = film.u[0];
    sample.pixel.set(0, {static_cast<float>(block.column[0]) + offset.x, static_cast<float>(block.row[0]) + offset.y});
    for (int n = 0; n < kMostOutlinePoints; ++n) {
        const OutlinePoint& point = points[n][0];
        const bool found = point.t > 0;
        const std::int64_t at = index + n * std::int64_t{part.count};
        edges[at] = {from_centre.line, point, found ? from_centre.weight(point) : 0.0};
        set_outline_ray(job.camera, point, found, sample.rays, 0);
        expose_rays(job.camera, block, sample.rays, sample.time);
        rays[at] = ray_of(job, sample);
    }
}

/// Returns the sums of this thread's warp, which are set to 0.
__device__ double* cleared_sums(const GradientJob& job, double* sums) {
    double* const own = sums + thread_index() / kWarpSize * job.sum_count;
    for (int i = threadIdx.x % kWarpSize; i < job.sum_count; i += kWarpSize) own[i] = 0;
    __syncwarp();
    return own;
}

/// Index of the sample that a thread takes in a step.
__device__ std::int64_t sample_index(int step) {
    return thread_index() / kWarpSize * kSamplesPerWarp + step * kWarpSize + threadIdx.x % kWarpSize;
}

template <int M>
__global__ void __launch_bounds__(kBlockSize, kLensBlocks)
    film_tangents_of(const __grid_constant__ GradientJob job, const AdjointFilm adjoint, Vec2d per_mm, int count,
                     const GradientRay* rays, double* sums) {
    WarpSums warp(job, cleared_sums(job, sums));
    for (int step = 0; step < kSamplesPerThread; ++step) {
        const std::int64_t index = sample_index(step);
        TangentRays<1, M> traced = ended_ray<M>(job);
        float variable = 0;
        if (index < count && rays[index].weight > 0.0f) {
            const GradientRay& ray = rays[index];
            const std::array<Vec3f, M> changes = adjoint.changes<M>(ray.pixel, ray.light, ray.weight);
            if (has_gradient(changes)) {
                variable = ray.variable;
                set_film_ray(job.outline, {ray.film.x, ray.film.y, 0}, {ray.cosines.x, ray.cosines.y, 0}, traced, 0);
                REALCAM_UNROLL
                for (int m = 0; m < M; ++m)
                    set_film_tangent(
                        traced, 0, m,
                        {per_mm.x * static_cast<double>(changes[m].y), per_mm.y * static_cast<double>(changes[m].z)});
            }
        }
        if (__all_sync(0xffffffffu, traced.status[0] != 0)) continue;
        const RayWavelength wavelength = wavelength_of(job, variable);
        trace_tangents_to_scene(
            job.tangents, [&](int k) { return wavelength.from(k); }, traced, nullptr, nullptr, warp);
        warp.finish_ray(traced, 0, 0);
    }
}

template <int M>
__global__ void __launch_bounds__(kBlockSize, kLensBlocks)
    outline_tangents_of(const __grid_constant__ GradientJob job, const AdjointFilm adjoint, double scale, int count,
                        const OutlineEdge* edges, const GradientRay* rays, double* sums) {
    WarpSums warp(job, cleared_sums(job, sums));
    for (int step = 0; step < kSamplesPerThread; ++step) {
        const std::int64_t index = sample_index(step);
        TangentRays<1, M> traced = ended_ray<M>(job);
        float variable = 0;
        int start[1] = {0};
        Vec3d tangents[M] = {};
        double by_stop = 0, by_rims = 0;
        if (index < count && rays[index].weight > 0.0f) {
            const OutlineEdge& edge = edges[index];
            const GradientRay& ray = rays[index];
            const auto density = static_cast<float>(edge.weight);
            const std::array<Vec3f, M> changes = adjoint.changes<M>(ray.pixel, density * ray.light, density);
            const DirectionLine lines[1] = {edge.line};
            const double t[1] = {edge.point.t};
            static_cast<LensRays<double, 1>&>(traced) = job.outline.start(lines, t);
            variable = ray.variable;
            start[0] = edge.point.surface;
            REALCAM_UNROLL
            for (int m = 0; m < M; ++m) tangents[m] = scale * static_cast<double>(changes[m].x) * edge.point.tangent;
            const double factor = scale * static_cast<double>(changes[0].x);
            by_stop = factor * edge.point.stop_rate, by_rims = factor * edge.point.rim_rate;
        }
        if (__all_sync(0xffffffffu, traced.status[0] != 0)) continue;
        const RayWavelength wavelength = wavelength_of(job, variable);
        trace_tangents_to_scene(job.tangents, [&](int k) { return wavelength.from(k); }, traced, start, tangents, warp);
        warp.finish_ray(traced, by_stop, by_rims);
    }
}

/// Each block has one of the sums, whose warps its threads add in a fixed order.
__global__ void add_sums_of(int sum_count, std::int64_t warps, const double* sums, double* totals) {
    __shared__ double of_threads[kBlockSize];
    double own = 0;
    for (std::int64_t warp = threadIdx.x; warp < warps; warp += kBlockSize) own += sums[warp * sum_count + blockIdx.x];
    of_threads[threadIdx.x] = own;
    for (int half = kBlockSize / 2; half > 0; half /= 2) {
        __syncthreads();
        if (static_cast<int>(threadIdx.x) < half) of_threads[threadIdx.x] += of_threads[threadIdx.x + half];
    }
    if (threadIdx.x == 0) totals[blockIdx.x] += of_threads[0];
}

__global__ void add_filtered_of(const __grid_constant__ GradientJob job, PixelFilter filter, const GradientPart part,
                                const GradientRay* rays, FilteredPixel* picture) {
    const std::int64_t index = thread_index();
    if (index >= part.count || !(rays[index].weight > 0.0f)) return;
    const SampleBlock<1> block = block_at(job, part, index);
    const float dither = unit_float(block.bits(0, 0));
    const Color light = rays[index].light;
    for_filtered_pixels(filter, job.film.width, job.film.height, rays[index].pixel, [&](int pixel, float value, Vec2f) {
        if (value != 0.0f) add_exact(picture[pixel].sums, value * light, dither);
    });
}

/// Number of blocks of kernels whose threads take kSamplesPerThread samples.
unsigned tangent_blocks(int count) {
    return blocks_for(gradient_warps(count) * kWarpSize);
}

}  // namespace

std::int64_t gradient_warps(int count) {
    constexpr int kWarpsPerBlock = kBlockSize / kWarpSize;
    const int warps = (count + kSamplesPerWarp - 1) / kSamplesPerWarp;
    return std::int64_t{(warps + kWarpsPerBlock - 1) / kWarpsPerBlock} * kWarpsPerBlock;
}

void launch_sample_film(const GradientJob& job, const GradientPart& part, GradientRay* rays, cudaStream_t stream) {
    const auto kernel =
        needs_general_lens_code(job.camera) ? sample_film_of<LensKind::any> : sample_film_of<LensKind::rotational>;
    kernel<<<blocks_for(part.count), kBlockSize, 0, stream>>>(job, part, rays);
    check_cuda(cudaGetLastError(), "starting to sample the film");
}

void launch_find_outline(const GradientJob& job, const GradientPart& part, OutlineEdge* edges, GradientRay* rays,
                         unsigned long long* unexplained, cudaStream_t stream) {
    const auto kernel =
        job.outline.lens.kind == LensKind::any ? find_outline_of<LensKind::any> : find_outline_of<LensKind::rotational>;
    kernel<<<blocks_for(part.count), kBlockSize, 0, stream>>>(job, part, edges, rays, unexplained);
    check_cuda(cudaGetLastError(), "starting to search the pupil's outline");
}

void launch_trace_light(const GradientJob& job, const GradientPart& part, std::int64_t ray_count, GradientRay* rays,
                        cudaStream_t stream) {
    const bool plain = kernel_scene_kind(job.scene, job.camera) == SceneKind::plain && job.scene.instance_count == 0;
    const auto kernel = plain ? trace_light_of<SceneKind::plain, false> : trace_light_of<SceneKind::any, true>;
    kernel<<<blocks_for(ray_count), kBlockSize, 0, stream>>>(job, part, ray_count, rays);
    check_cuda(cudaGetLastError(), "starting to trace paths");
}

void launch_film_tangents(const GradientJob& job, const AdjointFilm& adjoint, Vec2d per_mm, int count,
                          const GradientRay* rays, double* sums, cudaStream_t stream) {
    const auto kernel = adjoint.control ? film_tangents_of<2> : film_tangents_of<1>;
    kernel<<<tangent_blocks(count), kBlockSize, 0, stream>>>(job, adjoint, per_mm, count, rays, sums);
    check_cuda(cudaGetLastError(), "starting to trace tangents");
}

void launch_outline_tangents(const GradientJob& job, const AdjointFilm& adjoint, double scale, int count,
                             const OutlineEdge* edges, const GradientRay* rays, double* sums, cudaStream_t stream) {
    const auto kernel = adjoint.control ? outline_tangents_of<2> : outline_tangents_of<1>;
    kernel<<<tangent_blocks(count), kBlockSize, 0, stream>>>(job, adjoint, scale, count, edges, rays, sums);
    check_cuda(cudaGetLastError(), "starting to trace tangents");
}

void launch_add_sums(int sum_count, std::int64_t warps, const double* sums, double* totals, cudaStream_t stream) {
    add_sums_of<<<static_cast<unsigned>(sum_count), kBlockSize, 0, stream>>>(sum_count, warps, sums, totals);
    check_cuda(cudaGetLastError(), "starting to add sums");
}

void launch_add_filtered(const GradientJob& job, PixelFilter filter, const GradientPart& part, const GradientRay* rays,
                         FilteredPixel* picture, cudaStream_t stream) {
    add_filtered_of<<<blocks_for(part.count), kBlockSize, 0, stream>>>(job, filter, part, rays, picture);
    check_cuda(cudaGetLastError(), "starting to filter a picture");
}

}  // namespace realcam
