#pragma once
#include "../path/advance_path.hpp"

namespace REALCAM_NAMESPACE {

/// Probe of advance_paths that measures nothing.
struct NoProbe {
    REALCAM_INLINE void enter(RenderStage) const {}
};

/// Film samples of a picture for its derivatives, with the random numbers of the picture.
template <int N>
struct FilmSamples {
    Vec2Lanes<float, N> pixel;  ///< film point, in pixels from the upper left corner of the film
    Vec3Lanes<float, N> origin, direction;  ///< ray at the film, see FilmRaySample
    CameraRays<N> rays;
    Lanes<float, N> time;  ///< fraction of the exposure
    // If the camera has dispersion:
    SampleWavelengths<N> wavelengths;
    Lanes<float, N> variable;  ///< WavelengthVariable of each sample
};

/// Draws the wavelengths of samples.
template <int N>
REALCAM_HD inline void sample_wavelengths(const CameraView& camera, const SampleBlock<N>& block,
                                          FilmSamples<N>& samples) {
    draw_wavelengths(camera.dispersion, block, samples.wavelengths);
    REALCAM_LANES
    for (int i = 0; i < N; ++i) samples.variable[i] = camera.dispersion.variable.at(samples.wavelengths.nm[i]);
}

/// Samples film points, pupil points, times and wavelengths, and traces the rays through the lens.
template <LensKind lens_kind, int N>
REALCAM_HD inline void sample_film(const CameraView& camera, const SampleBlock<N>& block, FilmSamples<N>& samples) {
    const PixelPoints<N> film(camera, block);
    const LaneNumbers<N> u(block, dimension::pupil);
    for (int i = 0; i < N; ++i) {
        samples.pixel.set(
            i, {static_cast<float>(block.column[i]) + film.u[i].x, static_cast<float>(block.row[i]) + film.u[i].y});
        const FilmRaySample ray = sample_film_ray<lens_kind>(camera, film[i], u[i]);
        samples.origin.set(i, ray.origin);
        samples.direction.set(i, ray.direction);
    }
    if (camera.effects.dispersion) {
        LensRays<float, N> inside;
        sample_wavelengths(camera, block, samples);
        start_lens_rays<lens_kind>(camera, block, film, u, inside, samples.rays);
        trace_lens<lens_kind>(camera.lens, inside, NoRecord{},
                              ManyWavelengths{camera.dispersion.to_scene, samples.variable});
        set_camera_rays(camera, inside, samples.rays);
    } else {
        generate_rays_from<lens_kind>(camera, block, film, samples.rays);
    }
    expose_rays(camera, block, samples.rays, samples.time);
}

/// Traces the paths of rays that have left the lens; results.irradiance becomes the ray's weight times its radiance.
template <SceneKind scene_kind, int N, class SceneT>
REALCAM_HD inline void trace_radiance(const SceneView& view, const CameraView& camera, const PathSettings& settings,
                                      const SampleBlock<N>& block, const CameraRays<N>& rays,
                                      const Lanes<float, N>& time, SceneT&& scene, PathResults<N>& results) {
    PathState<N> path;
    REALCAM_LANES
    for (int i = 0; i < N; ++i) path.rays.time[i] = time[i];
    start_paths(rays, path, results);
    for (int bounce = 0;
         advance_paths<scene_kind>(view, camera, settings, block, bounce, scene, NoProbe{}, path, results);)
        ++bounce;
}

}  // namespace REALCAM_NAMESPACE
