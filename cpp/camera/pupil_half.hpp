#pragma once
#include "rays_with_effects.hpp"

namespace REALCAM_NAMESPACE {

// A dual pixel has two photodiodes under one micro-lens, which makes an image of the exit pupil on them: one sees the
// left half of the pupil, the other the right one (R. Garg et al., ICCV 2019, section 3). Here that image is ideal:
// micro-lenses are shifted towards the middle of the film, so that light from the axis of the pupil falls between the
// diodes all over the film, and no light is lost between them.

/// Sets `is_right` to 1 for samples that pass the right half of the exit pupil, as the photographer looks through the
/// lens. The paraxial pupil is halved; where rims vignette it, one half gets less light, as in a real camera.
template <Effects effects, int N>
REALCAM_HD inline void find_right_half(const CameraView& camera, const SampleBlock<N>& block,
                                       Lanes<std::int32_t, N>& is_right) {
    WavelengthsWith<N, effects> wavelengths;
    if constexpr (effects.have_wavelengths()) draw_wavelengths(camera.dispersion, block, wavelengths);
    const FilmPointsWith<N, effects> film(camera, block, wavelengths);
    const LaneNumbers<N> u(block, dimension::pupil);
    const bool has_real = has_real_pupil(camera.model);
    // Compares slopes instead of points in the pupil, which also holds for a pupil behind the film (negative distance).
    const float inverse_distance = 1.0f / camera.thick.exit_pupil_distance;
    for (int i = 0; i < N; ++i) {
        float right;
        if (has_real) {
            const FilmRaySample ray = sample_film_ray<LensKind::any>(camera, film[i], u[i]);
            right = ray.origin.x * inverse_distance - ray.direction.x / ray.direction.z;
        } else {
            right = sample_disc(u[i]).x;
        }
        is_right[i] = right > 0.0f ? 1 : 0;
    }
}

}  // namespace REALCAM_NAMESPACE
