#pragma once
#include "advance_path.hpp"

namespace REALCAM_NAMESPACE {

/// Takes one block of samples from the film, through the lens, to the scene and its lights: the whole path.
///
/// `lens_kind`: any, or the lens's own; `scene_kind`: any, or the scene's own. SceneT and Probe as in advance_paths. A
/// GPU thread runs this with N = 1.
template <LensKind lens_kind, SceneKind scene_kind, Effects effects = kNoEffects, int N, class SceneT, class Probe>
REALCAM_HD inline void render_samples(const SceneView& view, const CameraView& camera, const PathSettings& settings,
                                      const SampleBlock<N>& block, SceneT&& scene, Probe&& probe,
                                      PathResults<N>& results) {
    PathStateWith<N, effects> path;
    probe.enter(RenderStage::lens);
    begin_paths<lens_kind, scene_kind, effects>(camera, block, path, results);
    for (int bounce = 0; advance_paths<scene_kind>(view, camera, settings, block, bounce, scene, probe, path, results);)
        ++bounce;
    if constexpr (effects.have_wavelengths())
        for (int i = 0; i < N; ++i)
            results.irradiance.set(
                i, film_color<effects.coatings>(camera.dispersion, path.wavelengths, i, results.irradiance[i]));
}

}  // namespace REALCAM_NAMESPACE
