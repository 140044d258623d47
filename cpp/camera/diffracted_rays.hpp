#pragma once
#include "dispersed_rays.hpp"

namespace REALCAM_NAMESPACE {

// Light that geometrical optics brings to a film point reaches the points around it, too, as the lens's aperture
// diffracts it. So a sample of a film point looks for light from another one, that far away. The distance grows with
// the wavelength, so each sample has one.

/// Film points from which samples look into the lens.
template <int N>
struct DiffractedPoints {
    Vec2Lanes<float, N> points;  ///< mm
    Vec2Lanes<float, N> kicks;   ///< from them to the places of the samples, mm for each nm of wavelength
    Lanes<std::int32_t, N> from_edge;  ///< 1: see DiffractionKick

    REALCAM_INLINE Vec2f operator[](int lane) const { return points[lane]; }
};

/// Draws them. What would come from beyond the film is looked for at the sample's own place instead, so that no light
/// is lost at the margins.
template <int N>
REALCAM_HD inline void diffract(const CameraView& camera, const SampleBlock<N>& block, const float (&nm)[N],
                                DiffractedPoints<N>& film) {
    const DiffractionView view = camera.diffraction;
    const float reach_squared = view.largest_radius * view.largest_radius;
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        const Vec2f place = film_point(camera, block.column[i], block.row[i], block.random(i, dimension::film));
        const DiffractionKick kick = draw_kick(view, place, block.random(i, dimension::diffraction),
                                               block.random(i, dimension::diffraction + 1));
        const Vec2f from = {place.x - nm[i] * kick.mm_per_nm.x, place.y - nm[i] * kick.mm_per_nm.y};
        const bool on_film = from.x * from.x + from.y * from.y < reach_squared;
        film.points.set(i, {select(on_film, from.x, place.x), select(on_film, from.y, place.y)});
        film.kicks.set(i, {select(on_film, kick.mm_per_nm.x, 0.0f), select(on_film, kick.mm_per_nm.y, 0.0f)});
        film.from_edge[i] = select(on_film, kick.from_edge, 0);
    }
}

/// generate_rays with diffraction and nothing else: each sample has a wavelength, at which rays go as at the design
/// wavelength.
template <LensKind lens_kind, int N>
REALCAM_HD inline void generate_diffracted_rays(const CameraView& camera, const SampleBlock<N>& block,
                                                DiffractedPoints<N>& film, SampleWavelengths<N>& wavelengths,
                                                CameraRays<N>& rays) {
    const DispersionView& view = camera.dispersion;
    draw_wavelengths(view, block, wavelengths);
    diffract(camera, block, wavelengths.nm, film);
    generate_rays_from<lens_kind>(camera, block, film, rays);
    if (view.cell_count == 1) return;
    for (int step = 1; step < kSharedWavelengths; ++step) {
        REALCAM_LANES
        for (int i = 0; i < N; ++i) {
            const float nm = wavelength_at(view, shared_place(view, wavelengths.place[i], step));
            const Vec2f from = film[i], kick = film.kicks[i];
            const bool is_shared = lies_in_pixel(camera, block, i, {from.x + nm * kick.x, from.y + nm * kick.y});
            wavelengths.shares[i] |= select(is_shared, 1 << step, 0);
        }
    }
}

/// The same with all that a camera may have besides: each wavelength's indices, and coatings.
template <LensKind lens_kind, int N>
REALCAM_HD inline void generate_rays_with_all(const CameraView& camera, const SampleBlock<N>& block,
                                              DiffractedPoints<N>& film, SampleWavelengths<N>& wavelengths,
                                              CameraRays<N>& rays) {
    draw_wavelengths(camera.dispersion, block, wavelengths);
    diffract(camera, block, wavelengths.nm, film);
    if (camera.coatings.to_scene) {
        generate_dispersed_rays_from<lens_kind, true>(camera, block, film, film.kicks, wavelengths, rays);
        return;
    }
    generate_dispersed_rays_from<lens_kind, false>(camera, block, film, film.kicks, wavelengths, rays);
    for (auto& passed : wavelengths.passed)
        for (int i = 0; i < N; ++i) passed[i] = 1.0f;
}

}  // namespace REALCAM_NAMESPACE
