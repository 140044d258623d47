#pragma once
#include "advance_path.hpp"

namespace REALCAM_NAMESPACE {

/// Converts the irradiance of the sample in a lane, which was traced at one wavelength, into colours of the film. A
/// sample counts in equal parts at several wavelengths (hero wavelength sampling, Wilkie et al. 2014): at its own and
/// at those of the steps whose bit in `of.shares` is set. A part whose ray dispersion brings to another pixel goes to
/// results.shared. Also sets the excess of the sample (PathResultsWith). `coated`: each part is weighted with the
/// lens's transmittance at its wavelength.
template <bool coated, int N, Effects effects>
REALCAM_INLINE void count_wavelengths(const DispersionView& view, const SampleWavelengths<N>& of, int lane,
                                      PathResultsWith<N, effects>& results) {
    const Color scene = results.irradiance[lane];
    const std::int32_t shares = of.shares[lane];
    if constexpr (!effects.dispersion) {
        if (shares == kAllWavelengths) {
            results.irradiance.set(lane, film_color(view.film, scene));
            results.excess.set(lane, {0, 0, 0});
            return;
        }
    }
    const float part = 1.0f / static_cast<float>(count_bits(static_cast<unsigned>(shares)));
    const float passed = static_cast<float>(results.passed[lane]);
    Color own = {0, 0, 0}, excess = {-passed, -passed, -passed};
    REALCAM_UNROLL
    for (int step = 0; step < kSharedWavelengths; ++step) {
        Color color = {0, 0, 0}, white = {0, 0, 0};
        std::int32_t away = 0;
        if (shares >> step & 1) {
            const float weight = coated ? part * of.passed[step][lane] : part;
            const float cell_position = shared_cell_position(view, of.cell_position[lane], step);
            color = weight * film_color(view, cell_position, scene);
            const Color film = film_color(view, cell_position, {1, 1, 1});
            white = passed * weight *
                    Color{film.r * view.white_scale[0], film.g * view.white_scale[1], film.b * view.white_scale[2]};
            if (step > 0) away = of.away[step - 1][lane];
        }
        if (away == 0) {
            own += color;
            excess += white;
        }
        if constexpr (effects.share_pixels()) {
            if (step == 0) continue;
            results.shared.irradiance[step - 1].set(lane, color);
            results.shared.white[step - 1].set(lane, white);
            results.shared.away[step - 1][lane] = away;
        }
    }
    results.irradiance.set(lane, own);
    results.excess.set(lane, excess);
}

/// Renders a block of N samples by path tracing: from the film, through the lens, to the scene and its lights. `block`:
/// pixel and sample index of each lane; `results`: receives the irradiance of each lane.
///
/// `lens_kind`, `scene_kind`: `any`, or those of the lens and the scene (path_settings.hpp). `effects`: effects that
/// are simulated. `scene`, `probe`: see advance_paths. A GPU thread runs this with N = 1.
template <LensKind lens_kind, SceneKind scene_kind, Effects effects = kNoEffects, int N, class SceneT, class Probe>
REALCAM_HD inline void render_samples(const SceneView& view, const CameraView& camera, const PathSettings& settings,
                                      const SampleBlock<N>& block, SceneT&& scene, Probe&& probe,
                                      PathResultsWith<N, effects>& results) {
    PathStateWith<N, effects> path;
    probe.enter(RenderStage::lens);
    begin_paths<lens_kind, scene_kind, effects>(camera, block, path, results);
    for (int bounce = 0; advance_paths<scene_kind>(view, camera, settings, block, bounce, scene, probe, path, results);)
        ++bounce;
    if constexpr (effects.have_wavelengths())
        for (int i = 0; i < N; ++i)
            count_wavelengths<effects.coatings>(camera.dispersion, path.wavelengths, i, results);
}

}  // namespace REALCAM_NAMESPACE
