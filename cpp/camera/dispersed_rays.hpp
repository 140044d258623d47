#pragma once
#include "coated_rays.hpp"

namespace REALCAM_NAMESPACE {

// One wavelength a sample would be noisy: a film has three channels, and each would see a third of the samples. But the
// same ray outside the lens, at another wavelength, often belongs to another point of the same pixel. So it is traced
// back to the film at two more wavelengths, one third and two thirds of the list of cells further on. Where it ends in
// its pixel, that wavelength could have drawn it with the same density, because film and scene measure rays alike (the
// optical invariant). The sample counts for all that could, in equal parts (the balance heuristic of Veach and Guibas
// 1995). The three are the same whichever of them comes first, so that nothing is counted twice or left out.

/// Whether a film point lies in the pixel of a sample.
template <int N>
REALCAM_INLINE bool lies_in_pixel(const CameraView& camera, const SampleBlock<N>& block, int lane, Vec2f film) {
    const float columns_per_mm = -0.5f * static_cast<float>(camera.width) / camera.film_half_width;
    const float rows_per_mm = 0.5f * static_cast<float>(camera.height) / camera.film_half_height;
    const Vec2f corner = film_point(camera, block.column[lane], block.row[lane], {0.0f, 0.0f});
    const float column = columns_per_mm * (film.x - corner.x), row = rows_per_mm * (film.y - corner.y);
    return (column >= 0.0f) & (column < 1.0f) & (row >= 0.0f) & (row < 1.0f);
}

/// A wavelength for each sample, stratified over those of its pixel, for which alone it counts so far.
template <int N>
REALCAM_INLINE void draw_wavelengths(const DispersionView& view, const SampleBlock<N>& block,
                                     SampleWavelengths<N>& wavelengths) {
    const LaneNumbers<N> u(block, dimension::time);
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        wavelengths.place[i] = u[i].y * static_cast<float>(view.cell_count);
        wavelengths.shares[i] = 1;
    }
    REALCAM_LANES
    for (int i = 0; i < N; ++i) wavelengths.nm[i] = wavelength_at(view, wavelengths.place[i]);
}

/// Sets shares to the steps at which rays that have left the lens end in the pixels from which they came, and what the
/// lens passes on at their wavelengths, if it is `coated`.
template <LensKind lens_kind, bool coated, int N, class Points>
REALCAM_HD inline void find_shares(const CameraView& camera, const SampleBlock<N>& block,
                                   const LensRays<float, N>& left, const Points& film,
                                   SampleWavelengths<N>& wavelengths) {
    const DispersionView& view = camera.dispersion;
    LensView<float> to_film = camera.lens;
    to_film.surfaces = view.film_surfaces;
    to_film.free = view.film_free;
    for (int step = 1; step < kSharedWavelengths; ++step) {
        LensRays<float, N> back;
        Lanes<float, N> nm, variable;
        REALCAM_LANES
        for (int i = 0; i < N; ++i) {
            back.origin.set(i, left.origin[i]);
            back.direction.set(i, -left.direction[i]);
            back.status[i] = left.status[i];
            nm[i] = wavelength_at(view, shared_place(view, wavelengths.place[i], step));
            variable[i] = view.variable.at(nm[i]);
        }
        trace_surfaces<lens_kind, coated>(to_film, back, ManyWavelengths{view.to_film, variable},
                                          camera.coatings.to_film, variable, wavelengths.passed[step]);
        REALCAM_LANES
        for (int i = 0; i < N; ++i) {
            const Vec2f on_film = landing_on_film<lens_kind>(camera, back.origin[i], back.direction[i]);
            const Vec2f place = film.landing(i, on_film, nm[i]);
            const bool is_shared = (back.status[i] == 0) & lies_in_pixel(camera, block, i, place);
            wavelengths.shares[i] |= select(is_shared, 1 << step, 0);
        }
    }
}

/// The same of rays that go as at the design wavelength, whatever their own is.
template <int N, class Points>
REALCAM_INLINE void find_shares_of_landings(const CameraView& camera, const SampleBlock<N>& block, const Points& film,
                                            SampleWavelengths<N>& wavelengths) {
    const DispersionView& view = camera.dispersion;
    for (int step = 1; step < kSharedWavelengths; ++step) {
        REALCAM_LANES
        for (int i = 0; i < N; ++i) {
            const float nm = wavelength_at(view, shared_place(view, wavelengths.place[i], step));
            const bool is_shared = lies_in_pixel(camera, block, i, film.landing(i, film[i], nm));
            wavelengths.shares[i] |= select(is_shared, 1 << step, 0);
        }
    }
}

}  // namespace REALCAM_NAMESPACE
