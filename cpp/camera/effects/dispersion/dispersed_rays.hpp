#pragma once
#include "../../models/generate_rays.hpp"

namespace REALCAM_NAMESPACE {

/// Traces rays through the lens. `indices`: OneWavelength or ManyWavelengths. `coatings`, `variable`: transmittances of
/// the surfaces and the wavelength variable of each ray, for CoatedMedia. `passed`: transmitted fraction of each ray's
/// power; set only if the lens is `coated`.
template <LensKind lens_kind, bool coated, class Indices, int terms, int N>
REALCAM_HD inline void trace_surfaces(const LensView<float>& lens, LensRays<float, N>& rays, const Indices& indices,
                                      const CoatingPolynomials<terms>* coatings, const float* variable,
                                      float (&passed)[N]) {
    if constexpr (coated) {
        PassedPower<N> power;
        trace_lens<lens_kind>(lens, rays, NoRecord{},
                              CoatedMedia<Indices, terms, N>{indices, coatings, variable, power});
        REALCAM_LANES
        for (int i = 0; i < N; ++i) passed[i] = select(rays.status[i] == 0, power.of_unpolarised(i), 0.0f);
    } else {
        trace_lens<lens_kind>(lens, rays, NoRecord{}, indices);
    }
}

// With one wavelength per sample, pictures would be noisy: each of the film's three channels would see a third of the
// samples. But the same ray outside the lens belongs to other film points at other wavelengths. So it is traced back to
// the film at two more wavelengths, one third and two thirds of the list of cells further on (hero wavelength
// sampling). The pixel that it reaches could have sampled it at that wavelength with the same density, because film and
// scene measure rays alike (the optical invariant). The sample counts in all these pixels in equal parts (balance
// heuristic of Veach and Guibas 1995), provided that they lie in the tile of its own pixel (SampleSharing). The set of
// three does not depend on which of them is sampled, so nothing is counted twice or left out.

/// Offset of a pixel from a sample's own pixel.
struct PixelOffset {
    int right, down;
    bool is_near;  ///< false: right and down are invalid

    REALCAM_INLINE bool is_own() const { return is_near & (right == 0) & (down == 0); }
};

/// Offset of the pixel of a film point (mm) from a lane's own pixel; not near if it is farther away than the size of a
/// tile.
template <int N>
REALCAM_INLINE PixelOffset pixel_at(const CameraView& camera, const SampleBlock<N>& block, int lane, Vec2f film) {
    const float columns_per_mm = -0.5f * static_cast<float>(camera.width) / camera.film_half_width;
    const float rows_per_mm = 0.5f * static_cast<float>(camera.height) / camera.film_half_height;
    const Vec2f corner = film_point(camera, block.column[lane], block.row[lane], {0.0f, 0.0f});
    const float column = columns_per_mm * (film.x - corner.x), row = rows_per_mm * (film.y - corner.y);
    constexpr float kFar = SampleSharing::kTileSide;  // beyond it, offsets may not fit into integers
    const bool is_near = (std::abs(column) < kFar) & (std::abs(row) < kFar);
    return {static_cast<int>(std::floor(select(is_near, column, 0.0f))),
            static_cast<int>(std::floor(select(is_near, row, 0.0f))), is_near};
}

/// Lets a lane's sample count, at wavelength step `step`, in the pixel of a film point (mm) if `arrives` is true and
/// the pixel is its own or one in the same tile. Sets the bit in SampleWavelengths::shares, and the offset.
template <int N>
REALCAM_INLINE void share(const CameraView& camera, const SampleBlock<N>& block, int lane, int step, bool arrives,
                          Vec2f film, SampleWavelengths<N>& wavelengths) {
    const SampleSharing& sharing = camera.dispersion.sharing;
    const PixelOffset pixel = pixel_at(camera, block, lane, film);
    const bool counts =
        arrives & pixel.is_near &
        (pixel.is_own() | sharing.has_both(block.column[lane], block.row[lane], block.column[lane] + pixel.right,
                                           block.row[lane] + pixel.down));
    wavelengths.shares[lane] |= select(counts, 1 << step, 0);
    wavelengths.away[step - 1][lane] = pixel.down * sharing.stride + pixel.right;
}

/// True if samples count at further wavelengths than their own. The density of samples is that of other wavelengths
/// only if it is uniform: with a filter other than the box, it depends on the film point.
REALCAM_INLINE bool shares_wavelengths(const CameraView& camera) {
    return camera.dispersion.cell_count > 1 && camera.filter == PixelFilter::box;
}

/// Samples a wavelength for each sample, stratified over the samples of its pixel. At first, a sample counts for this
/// wavelength alone.
template <int N>
REALCAM_INLINE void draw_wavelengths(const DispersionView& view, const SampleBlock<N>& block,
                                     SampleWavelengths<N>& wavelengths) {
    const LaneNumbers<N> u(block, dimension::time);
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        wavelengths.cell_position[i] = u[i].y * static_cast<float>(view.cell_count);
        wavelengths.shares[i] = 1;
    }
    REALCAM_LANES
    for (int i = 0; i < N; ++i) wavelengths.nm[i] = wavelength_at(view, wavelengths.cell_position[i]);
}

/// Finds the pixels in which rays that have left the lens count at the further wavelengths, and the lens's
/// transmittance at these wavelengths if it is `coated`. `left`: rays that have left the lens; `film`: see
/// FilmPointsWith.
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
            nm[i] = wavelength_at(view, shared_cell_position(view, wavelengths.cell_position[i], step));
            variable[i] = view.variable.at(nm[i]);
        }
        trace_surfaces<lens_kind, coated>(to_film, back, ManyWavelengths{view.to_film, variable},
                                          camera.coatings.to_film, variable, wavelengths.passed[step]);
        REALCAM_LANES
        for (int i = 0; i < N; ++i) {
            Vec2f on_film = landing_on_film<lens_kind>(camera, back.origin[i], back.direction[i]);
            if (camera.bundles.nodes) on_film = picture_landing(camera.bundles, film[i], on_film).film;
            share(camera, block, i, step, back.status[i] == 0, film.landing(i, on_film, nm[i]), wavelengths);
        }
    }
}

/// find_shares for rays that are traced at the design wavelength whatever their own is. On the film, their light lies
/// on a line, by wavelength. If both of its ends are in the sample's pixel, all wavelengths could have sampled it.
template <int N, class Points>
REALCAM_INLINE void find_shares_of_landings(const CameraView& camera, const SampleBlock<N>& block, const Points& film,
                                            SampleWavelengths<N>& wavelengths) {
    const DispersionView& view = camera.dispersion;
    for (int step = 1; step < kSharedWavelengths; ++step) {
        REALCAM_LANES
        for (int i = 0; i < N; ++i) {
            const float nm = wavelength_at(view, shared_cell_position(view, wavelengths.cell_position[i], step));
            share(camera, block, i, step, true, film.landing(i, film[i], nm), wavelengths);
        }
    }
    const float ends_nm[] = {view.cells[0].first_nm, view.cells[view.cell_count - 1].last_nm};
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        bool all_stay = true;
        for (const float nm : ends_nm) all_stay &= pixel_at(camera, block, i, film.landing(i, film[i], nm)).is_own();
        wavelengths.shares[i] = select(all_stay, kAllWavelengths, wavelengths.shares[i]);
    }
}

}  // namespace REALCAM_NAMESPACE
