#pragma once
#include <type_traits>

#include "diffraction/diffracted_rays.hpp"

namespace REALCAM_NAMESPACE {

// Rays of a camera with any set of effects, stage by stage: wavelengths, film points, the lens, and the further
// wavelengths for which a sample counts. Each effect takes part in the stages that concern it.

/// Replaces SampleWavelengths for samples without wavelengths.
struct NoWavelengths {};
template <int N, Effects effects>
using WavelengthsWith = std::conditional_t<effects.have_wavelengths(), SampleWavelengths<N>, NoWavelengths>;

/// Film points from which rays are sent into the lens: PixelPoints or, with diffraction, DiffractedPoints.
template <int N, Effects effects>
struct FilmPointsWith : PixelPoints<N> {
    REALCAM_INLINE FilmPointsWith(const CameraView& camera, const SampleBlock<N>& block,
                                  const WavelengthsWith<N, effects>&)
        : PixelPoints<N>(camera, block) {}
};
template <int N, Effects effects>
    requires(effects.diffraction)
struct FilmPointsWith<N, effects> : DiffractedPoints<N> {
    REALCAM_INLINE FilmPointsWith(const CameraView& camera, const SampleBlock<N>& block,
                                  const WavelengthsWith<N, effects>& wavelengths) {
        diffract(camera, block, wavelengths.nm, *this);
    }
};

/// generate_rays_from for a full lens with dispersion or coatings. Sets wavelengths.passed, and multiplies the weights
/// by the lens's transmittance if samples have no wavelengths.
template <LensKind lens_kind, Effects effects, int N, class Points>
REALCAM_HD inline void generate_surface_rays(const CameraView& camera, const SampleBlock<N>& block, const Points& film,
                                             [[maybe_unused]] WavelengthsWith<N, effects>& wavelengths,
                                             CameraRays<N>& rays) {
    const LaneNumbers<N> u(block, dimension::pupil);
    LensRays<float, N> inside;
    if constexpr (effects.have_wavelengths()) {
        const DispersionView& view = camera.dispersion;
        Lanes<float, N> variable;
        REALCAM_LANES
        for (int i = 0; i < N; ++i) variable[i] = view.variable.at(wavelengths.nm[i]);
        start_lens_rays<lens_kind>(camera, block, film, u, inside, rays);
        trace_surfaces<lens_kind, effects.coatings>(camera.lens, inside, ManyWavelengths{view.to_scene, variable},
                                                    camera.coatings.to_scene, variable, wavelengths.passed[0]);
        if (shares_wavelengths(camera))
            find_shares<lens_kind, effects.coatings>(camera, block, inside, film, wavelengths);
    } else {
        Lanes<float, N> passed;
        start_lens_rays<lens_kind>(camera, block, film, u, inside, rays);
        trace_surfaces<lens_kind, true>(camera.lens, inside, OneWavelength{}, camera.coatings.one_wavelength, nullptr,
                                        passed);
        REALCAM_LANES
        for (int i = 0; i < N; ++i) rays.weight[i] *= passed[i];
    }
    set_camera_rays(camera, inside, rays);
    move_bundles(camera, film, rays);
}

/// generate_rays_from with effects. Wavelengths must have been sampled already; the further wavelengths for which
/// samples count, and the lens's transmittance at each (film_color), are added.
template <LensKind lens_kind, Effects effects, int N, class Points>
REALCAM_HD inline void generate_rays_with(const CameraView& camera, const SampleBlock<N>& block, const Points& film,
                                          [[maybe_unused]] WavelengthsWith<N, effects>& wavelengths,
                                          CameraRays<N>& rays) {
    if constexpr (may_lack_coatings(effects)) {
        if (!camera.effects.coatings) {
            constexpr Effects kWithout = without_coatings(effects);
            generate_rays_with<lens_kind, kWithout>(camera, block, film, wavelengths, rays);
            for (auto& passed : wavelengths.passed)
                for (int i = 0; i < N; ++i) passed[i] = 1.0f;
            return;
        }
    }
    if constexpr (effects.dispersion || effects.coatings) {
        generate_surface_rays<lens_kind, effects>(camera, block, film, wavelengths, rays);
    } else {
        generate_rays_from<lens_kind>(camera, block, film, rays);
        if constexpr (effects.have_wavelengths()) {
            if (shares_wavelengths(camera)) find_shares_of_landings(camera, block, film, wavelengths);
        }
    }
}

}  // namespace REALCAM_NAMESPACE
