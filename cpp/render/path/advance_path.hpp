#pragma once
#include <type_traits>

#include "../../camera/effects/rays_with_effects.hpp"
#include "../../camera/models/generate_rays.hpp"
#include "cross_medium.hpp"
#include "path_state.hpp"
#include "scatter_glossy_paths.hpp"
#include "scatter_plain_paths.hpp"

namespace REALCAM_NAMESPACE {

/// Sets the density for the MIS weight of an emitter that a camera ray hits, if that emitter is also sampled from the
/// lights (splat_ghosts.hpp): as if the ray's direction had been sampled at the front vertex with this density, per
/// steradian. `lane`: also the slot, because the path has just started.
template <SceneKind scene_kind, int N>
REALCAM_INLINE void set_first_density(const CameraView& camera, float density, int lane, PathState<N>& path) {
    Vec3f front = front_vertex(camera, camera.front_vertex_m);
    if constexpr (scene_kind == SceneKind::any) {
        front = front_vertex(camera_at(camera, path.rays.time[lane]), camera.front_vertex_m);
        path.receiver_sky[lane] = SkySampling::chosen;
    }
    if constexpr (scene_kind != SceneKind::plain) path.set_receiver_lobe(lane, {});
    path.pdf[lane] = density;
    path.receiver_position.set(lane, front);
    path.receiver_normal.set(lane, {0, 0, 0});
}

/// Initialises the state and the results of paths with the rays that have left the lens; other paths are inactive.
template <int N>
REALCAM_INLINE void start_paths(const CameraRays<N>& camera_rays, PathState<N>& path, PathResults<N>& results) {
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        path.rays.origin.set(i, camera_rays.origin[i]);
        path.rays.direction.set(i, camera_rays.direction[i]);
        path.rays.far[i] = kFarAway;
        path.rays.active[i] = camera_rays.passed[i];
        path.weight[i] = camera_rays.weight[i];
        path.throughput.set(i, grey(camera_rays.weight[i]));
        path.pdf[i] = kFromFilm;
        path.interior[i] = nullptr;
        results.irradiance.set(i, {0, 0, 0});
        results.depth[i] = kFarAway;
        results.weight[i] = camera_rays.weight[i];
        results.sampled[i] = camera_rays.sampled[i];
        results.passed[i] = camera_rays.passed[i];
    }
}

/// Stage of a render kernel, for measuring its time: camera rays through the lens, ray-scene intersection, and all
/// other work.
enum class RenderStage { lens, scene, other };

namespace advance_path_detail {

/// First bounce with Russian roulette.
inline constexpr int kFirstRoulette = 3;

/// Russian roulette: continues the path in a slot with the probability q, and then divides its throughput by q. q is
/// the largest channel of its throughput over its initial weight, at most 1.
template <int N>
REALCAM_INLINE void apply_roulette(const SampleBlock<N>& block, int bounce, int slot, PathState<N>& path) {
    const Color throughput = path.throughput[slot];
    const float survival = largest(throughput) / path.weight[slot];
    if (!(survival < 1.0f)) return;
    const float u = block.random(path.lane(slot), dimension::roulette + static_cast<std::uint32_t>(bounce)).x;
    if (u < survival)
        path.throughput.set(slot, (1.0f / survival) * throughput);
    else
        path.rays.active[slot] = 0;
}

/// Returns true if any ray is to be traced.
template <int N>
REALCAM_INLINE bool any_active(const SceneRays<N>& rays) {
    std::int32_t any = 0;
    for (int i = 0; i < N; ++i) any |= rays.active[i];
    return any != 0;
}

/// Traces one shadow ray per path, and adds the contributions of those that are not occluded. `is_shadow_catcher(i)`:
/// true if the path in slot i ends if its shadow ray is occluded. `scene`, `probe`: as in advance_paths.
template <SceneKind scene_kind, int N, class SceneT, class Probe, class IsShadowCatcher>
REALCAM_INLINE void add_unoccluded_light(const ShadowRays<N>& light, SceneT&& scene, Probe&& probe,
                                         const IsShadowCatcher& is_shadow_catcher, PathState<N>& path,
                                         PathResults<N>& results) {
    if (!any_active(light.rays)) return;
    Lanes<std::int32_t, N> occluded;
    probe.enter(RenderStage::scene);
    scene.occluded(light.rays, occluded);
    probe.enter(RenderStage::other);
    const int slots = path.slots();
    for (int i = 0; i < slots; ++i) {
        const int lane = path.lane(i);
        if (light.rays.active[i] & !occluded[i])
            results.irradiance.set(lane, results.irradiance[lane] + light.unoccluded[i]);
        if constexpr (scene_kind == SceneKind::any) {
            if (is_shadow_catcher(i) & light.rays.active[i] & occluded[i]) path.rays.active[i] = 0;
        }
    }
}

/// Sets time and random bits of the shadow ray for light sample `number`, which only scenes of SceneKind::any need.
template <SceneKind scene_kind, int N>
REALCAM_INLINE void set_time_and_number(const PathState<N>& path, int slot, int number, SceneRays<N>& rays) {
    if constexpr (scene_kind == SceneKind::any) {
        rays.number[slot] = shadow_ray_number(hash32(path.rays.number[slot] + static_cast<std::uint32_t>(number)));
        rays.time[slot] = path.rays.time[slot];
    }
}

/// Adds the light that the air or scattering glass scatters along each ray, and attenuates the paths or marks them as
/// scattered by it (kScatteredInMedium). `hits`: of the rays; modified.
template <int N, class SceneT, class Probe>
REALCAM_INLINE void cross_media(const SceneView& view, const CameraView& camera, const PathSettings& settings,
                                const SampleBlock<N>& block, int bounce, SceneT&& scene, Probe&& probe, Hits<N>& hits,
                                PathState<N>& path, PathResults<N>& results) {
    const std::uint32_t dimension = dimension::medium + 3 * static_cast<std::uint32_t>(bounce);
    const PathNumbers<N> points(block, path, dimension), lights(block, path, dimension + 1),
        paths(block, path, dimension + 2);
    ShadowRays<N> shadow;
    for (int i = 0; i < N; ++i) shadow.rays.active[i] = 0;
    const int slots = path.slots();
    for (int i = 0; i < slots; ++i) {
        if (!path.rays.active[i]) continue;
        const bool is_hit = hits.triangle[i] != kNoTriangle;
        const Material* interior = path.interior[i];
        // A ray that leaves the scene from the interior of glass has passed a gap in its surface.
        if (interior ? !is_hit || !interior->has_scattering_interior() : !view.air.is_present()) continue;
        const int lane = path.lane(i);
        const Vec3f origin = path.rays.origin[i], direction = path.rays.direction[i];
        const MediumCrossing crossing = cross_medium(
            view,
            {origin, direction, is_hit ? hits.distance[i] : kFarAway, path.rays.time[i], path.throughput[i], interior},
            all_lobes_scatter(settings, bounce), {points[i], lights[i], paths[i], block.bits(lane, dimension)});
        if (bounce <= settings.max_bounces && !is_black(crossing.from_light)) {
            const float limit = bounce > 0 ? settings.clamp * path.weight[i] : 0.0f;
            set_time_and_number<SceneKind::any>(path, i, kLightSampleCount, shadow.rays);
            shadow.set(i, {crossing.scattering_point, {0, 0, 0}, 0.0f}, crossing.light,
                       clamped(crossing.from_light, limit));
        }
        path.throughput.set(i, path.throughput[i] * crossing.weight);
        if (crossing.scattered_at < 0.0f) continue;
        if (bounce == 0 && is_hit)
            results.depth[lane] = shade_hits_detail::depth_at<SceneKind::any>(
                camera, origin + hits.distance[i] * direction, path.rays.time[i]);
        hits.triangle[i] = kScatteredInMedium;
        hits.distance[i] = crossing.scattered_at;
        path.pdf[i] = crossing.density_ratio;
    }
    add_unoccluded_light<SceneKind::any>(shadow, scene, probe, [](int) { return false; }, path, results);
}

/// Scatters the path of a GPU's thread, which has registers for one shadow ray: each ray is traced right after it is
/// set.
template <SceneKind scene_kind, class SceneT, class Probe>
REALCAM_INLINE void scatter_one(const SceneView& view, const PathSettings& settings, const SampleBlock<1>& block,
                                int bounce, const Surfaces<1>& surfaces, SceneT&& scene, Probe&& probe,
                                PathState<1>& path, PathResults<1>& results) {
    struct {
        ShadowRays<1> ray;
        SceneT& scene;
        Probe& probe;
        PathState<1>& path;
        PathResults<1>& results;

        REALCAM_INLINE ShadowRays<1>& operator[](int number) {
            set_time_and_number<scene_kind>(path, 0, number, ray.rays);
            return ray;
        }
        REALCAM_INLINE void trace(int, bool is_shadow_catcher) {
            add_unoccluded_light<scene_kind>(ray, scene, probe, [=](int) { return is_shadow_catcher; }, path, results);
        }
    } shadow{{}, scene, probe, path, results};
    const std::uint32_t first_dimension = dimension::of_bounce(bounce);
    scatter_at<scene_kind>(view, settings, bounce, 0, surfaces.points[0],
                           PathNumbers<1>(block, path, first_dimension + dimension::light),
                           PathNumbers<1>(block, path, first_dimension + dimension::scatter),
                           block.bits(0, first_dimension), path, shadow);
}

/// Scatters the paths of a block on a CPU, and then traces all their shadow rays together.
template <SceneKind scene_kind, int N, class SurfacesT, class SceneT, class Probe>
REALCAM_INLINE void scatter_many(const SceneView& view, const PathSettings& settings, const SampleBlock<N>& block,
                                 int bounce, SurfacesT& surfaces, SceneT&& scene, Probe&& probe, PathState<N>& path,
                                 PathResults<N>& results) {
    LightRays<N> shadow;
    std::int32_t is_shadow_catcher[N];  // read for SceneKind::any only
    for (int k = 0; k < kLightSampleCount; ++k) {
        REALCAM_LANES
        for (int i = 0; i < N; ++i) shadow[k].rays.active[i] = 0;  // including unused slots
        for (int i = 0; i < path.count; ++i) set_time_and_number<scene_kind>(path, i, k, shadow[k].rays);
    }
    if constexpr (scene_kind == SceneKind::plain)
        scatter_plain_paths(view, settings, block, bounce, surfaces, path, shadow);
    else
        scatter_glossy_paths<scene_kind>(view, settings, block, bounce, surfaces, path, shadow, is_shadow_catcher);
    for (const ShadowRays<N>& light : shadow.rays)
        add_unoccluded_light<scene_kind>(
            light, scene, probe, [&](int i) { return is_shadow_catcher[i]; }, path, results);
}

}  // namespace advance_path_detail

/// Generates the camera rays of a block of samples, from the film through the lens, and starts their paths. Sets all of
/// `path` and `results` that later bounces read.
template <LensKind lens_kind, SceneKind scene_kind, Effects effects = kNoEffects, int N>
REALCAM_HD inline void begin_paths(const CameraView& camera, const SampleBlock<N>& block,
                                   PathStateWith<N, effects>& path, PathResults<N>& results) {
    CameraRays<N> camera_rays;
    if constexpr (effects.have_wavelengths()) draw_wavelengths(camera.dispersion, block, path.wavelengths);
    const FilmPointsWith<N, effects> film(camera, block, path.wavelengths);
    generate_rays_with<lens_kind, effects>(camera, block, film, path.wavelengths, camera_rays);
    if constexpr (scene_kind == SceneKind::any) expose_rays(camera, block, camera_rays, path.rays.time);
    start_paths(camera_rays, path, results);
    // Rays that the edges of the aperture diffract also find lamps. Starbursts find the same light by splatting; with
    // splat_density, the MIS weights are equal where both methods sample equally well.
    if constexpr (effects.diffraction) {
        REALCAM_LANES
        for (int i = 0; i < N; ++i)
            set_first_density<scene_kind>(
                camera, select(film.from_edge[i] != 0, camera.diffraction.splat_density, kFromFilm), i, path);
    }
}

/// Traces each path to its next surface, adds the emitted and the direct light there, and samples its next ray. Returns
/// true if any path continues. `bounce`: 0 for camera rays. `SceneT` provides intersect(rays, hits) and occluded(rays,
/// occluded), which sets a 1 for each occluded ray, for N rays; `Probe` provides enter(RenderStage), which measures the
/// time of the stages or does nothing.
template <SceneKind scene_kind, int N, class SceneT, class Probe>
REALCAM_HD inline bool advance_paths(const SceneView& view, const CameraView& camera, const PathSettings& settings,
                                     const SampleBlock<N>& block, int bounce, SceneT&& scene, Probe&& probe,
                                     PathState<N>& path, PathResults<N>& results) {
    using namespace advance_path_detail;
    constexpr bool kIsPlain = scene_kind == SceneKind::plain;
    Hits<N> hits;
    std::conditional_t<N == 1, Surfaces<N>, std::conditional_t<kIsPlain, PlainSurfaces<N>, GlossySurfaces<N>>> surfaces;
    if constexpr (scene_kind == SceneKind::any) {
        const int slots = path.slots();
        for (int i = 0; i < slots; ++i) path.rays.number[i] = ray_number(block, path.lane(i), bounce);
    }
    probe.enter(RenderStage::scene);
    scene.intersect(path.rays, hits);
    probe.enter(RenderStage::other);
    if constexpr (scene_kind == SceneKind::any) {
        if (view.has_scattering_media)
            cross_media(view, camera, settings, block, bounce, scene, probe, hits, path, results);
    }
    shade_hits<scene_kind>(view, camera, settings, block, bounce, hits, path, results, surfaces);
    // On a GPU this return frees the registers of the values that only continuing paths need.
    if (path.count == 0) return false;
    const int slots = path.slots();
    if constexpr (N == 1)
        scatter_one<scene_kind>(view, settings, block, bounce, surfaces, scene, probe, path, results);
    else
        scatter_many<scene_kind>(view, settings, block, bounce, surfaces, scene, probe, path, results);
    if (bounce >= kFirstRoulette) {
        for (int i = 0; i < slots; ++i)
            if (path.rays.active[i]) apply_roulette(block, bounce, i, path);
    }
    return any_active(path.rays);
}

}  // namespace REALCAM_NAMESPACE
