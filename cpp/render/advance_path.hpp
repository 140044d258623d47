#pragma once
#include <type_traits>

#include "../camera/rays_with_effects.hpp"
#include "scatter_glossy_paths.hpp"
#include "scatter_plain_paths.hpp"
#include "start_paths.hpp"

namespace REALCAM_NAMESPACE {

enum class RenderStage { lens, scene, other };

namespace advance_path_detail {

/// Russian roulette begins at this bounce: dim paths are ended at random, and those that are kept count more.
inline constexpr int kFirstRoulette = 3;

/// Ends a path with the probability that its throughput has lost.
template <int N>
REALCAM_INLINE void play_roulette(const SampleBlock<N>& block, int bounce, int place, PathState<N>& path) {
    const Color throughput = path.throughput[place];
    const float kept = largest(throughput) / path.weight[place];
    if (!(kept < 1.0f)) return;
    const float u = block.random(path.lane(place), dimension::roulette + static_cast<std::uint32_t>(bounce)).x;
    if (u < kept)
        path.throughput.set(place, (1.0f / kept) * throughput);
    else
        path.rays.active[place] = 0;
}

template <int N>
REALCAM_INLINE bool any_active(const SceneRays<N>& rays) {
    std::int32_t any = 0;
    for (int i = 0; i < N; ++i) any |= rays.active[i];
    return any != 0;
}

}  // namespace advance_path_detail

/// Rays from the film through the lens.
template <LensKind lens_kind, SceneKind scene_kind, Effects effects = kNoEffects, int N>
REALCAM_HD inline void begin_paths(const CameraView& camera, const SampleBlock<N>& block,
                                   PathStateWith<N, effects>& path, PathResults<N>& results) {
    CameraRays<N> camera_rays;
    if constexpr (effects.have_wavelengths()) draw_wavelengths(camera.dispersion, block, path.wavelengths);
    const FilmPointsWith<N, effects> film(camera, block, path.wavelengths);
    generate_rays_with<lens_kind, effects>(camera, block, film, path.wavelengths, camera_rays);
    if constexpr (scene_kind == SceneKind::any) expose_rays(camera, block, camera_rays, path.rays.time);
    start_paths(camera_rays, path, results);
    // The edges of the aperture spread the light of lamps, which is looked for with the density at which both ways are
    // as good.
    if constexpr (effects.diffraction) {
        REALCAM_LANES
        for (int i = 0; i < N; ++i)
            set_first_density<scene_kind>(
                camera, select(film.from_edge[i] != 0, camera.diffraction.splat_density, kFromFilm), i, path);
    }
}

/// Takes each path to the next surface, collects the light that reaches it there, and scatters it. Returns whether any
/// goes on. `SceneT` offers intersect(rays, hits) and occluded(rays, hidden) for N rays; `Probe` offers
/// enter(RenderStage) and costs nothing where nobody asks for the time.
template <SceneKind scene_kind, int N, class SceneT, class Probe>
REALCAM_HD inline bool advance_paths(const SceneView& view, const CameraView& camera, const PathSettings& settings,
                                     const SampleBlock<N>& block, int bounce, SceneT&& scene, Probe&& probe,
                                     PathState<N>& path, PathResults<N>& results) {
    using namespace advance_path_detail;
    constexpr bool kIsPlain = scene_kind == SceneKind::plain;
    Hits<N> hits;
    std::conditional_t<N == 1, Surfaces<N>, std::conditional_t<kIsPlain, PlainSurfaces<N>, GlossySurfaces<N>>> surfaces;
    ShadowRays<N> shadow;
    Lanes<std::int32_t, N> hidden;
    std::int32_t darkens[N];  // surfaces that show nothing but shadows

    if constexpr (scene_kind == SceneKind::any) {
        const int places = path.places();
        for (int i = 0; i < places; ++i) path.rays.number[i] = ray_number(block, path.lane(i), bounce);
    }
    probe.enter(RenderStage::scene);
    scene.intersect(path.rays, hits);
    probe.enter(RenderStage::other);
    meet_surfaces<scene_kind>(view, camera, settings, block, bounce, hits, path, results, surfaces);
    if (path.count == 0) return false;  // on a GPU, so that registers do not keep what only continuing paths need
    const int places = path.places();
    if constexpr (N > 1) {  // also of the places that are not in use
        REALCAM_LANES
        for (int i = 0; i < N; ++i) shadow.rays.active[i] = 0;
    }
    if constexpr (scene_kind == SceneKind::any) {
        for (int i = 0; i < places; ++i) {
            shadow.rays.number[i] = shadow_ray_number(hash32(path.rays.number[i]));
            shadow.rays.time[i] = path.rays.time[i];
        }
    }
    if constexpr (N == 1)
        scatter_paths<scene_kind>(view, settings, block, bounce, surfaces, path, shadow, darkens);
    else if constexpr (kIsPlain)
        scatter_plain_paths(view, settings, block, bounce, surfaces, path, shadow);
    else
        scatter_glossy_paths<scene_kind>(view, settings, block, bounce, surfaces, path, shadow, darkens);
    if (bounce >= kFirstRoulette) {
        for (int i = 0; i < places; ++i)
            if (path.rays.active[i]) play_roulette(block, bounce, i, path);
    }
    if (any_active(shadow.rays)) {
        probe.enter(RenderStage::scene);
        scene.occluded(shadow.rays, hidden);
        probe.enter(RenderStage::other);
        for (int i = 0; i < places; ++i) {
            const int lane = path.lane(i);
            if (shadow.rays.active[i] & !hidden[i])
                results.irradiance.set(lane, results.irradiance[lane] + shadow.unshadowed[i]);
            if constexpr (scene_kind == SceneKind::any) {
                if (darkens[i] & shadow.rays.active[i] & hidden[i]) path.rays.active[i] = 0;
            }
        }
    }
    return any_active(path.rays);
}

}  // namespace REALCAM_NAMESPACE
