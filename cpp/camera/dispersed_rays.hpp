#pragma once
#include <type_traits>

#include "generate_rays.hpp"

namespace REALCAM_NAMESPACE {

// One wavelength a sample would be noisy: a film has three channels, and each would see a third of the samples. But a
// ray that has left the lens would often have come from the same pixel, if from another point of it, at another
// wavelength too. So it is taken back to the film at two more, a third of the cells apart each. Where it ends in its
// pixel, that wavelength could have drawn it, with the same density, because film and scene measure rays alike (the
// optical invariant): the sample counts for all that could, in equal parts (the balance heuristic of Veach and Guibas
// 1995). The three are the same whichever of them comes first, so that nothing is counted twice or left out.

/// Nothing takes samples elsewhere on the film than to their pixels.
struct NoKicks {};

/// Whether a film point lies in the pixel of a sample.
template <int N>
REALCAM_INLINE bool lies_in_pixel(const CameraView& camera, const SampleBlock<N>& block, int lane, Vec2f film) {
    const float columns_per_mm = -0.5f * static_cast<float>(camera.width) / camera.film_half_width;
    const float rows_per_mm = 0.5f * static_cast<float>(camera.height) / camera.film_half_height;
    const Vec2f corner = film_point(camera, block.column[lane], block.row[lane], {0.0f, 0.0f});
    const float column = columns_per_mm * (film.x - corner.x), row = rows_per_mm * (film.y - corner.y);
    return (column >= 0.0f) & (column < 1.0f) & (row >= 0.0f) & (row < 1.0f);
}

namespace dispersed_rays_detail {

/// Takes rays through the lens, each with its WavelengthVariable. `passed`: what they keep, if the lens is `coated`.
template <LensKind lens_kind, bool coated, int N>
REALCAM_HD inline void trace_dispersed(const LensView<float>& lens, LensRays<float, N>& rays, const IndexCubic* indices,
                                       const CoatingPolynomials<kSpectrumTerms>* coatings, const float (&variable)[N],
                                       float (&passed)[N]) {
    const ManyWavelengths media{indices, variable};
    if constexpr (coated) {
        PassedPower<N> power;
        trace_lens<lens_kind>(lens, rays, NoRecord{},
                              CoatedMedia<ManyWavelengths, kSpectrumTerms, N>{media, coatings, variable, power});
        REALCAM_LANES
        for (int i = 0; i < N; ++i) passed[i] = select(rays.status[i] == 0, power.of_unpolarised(i), 0.0f);
    } else {
        trace_lens<lens_kind>(lens, rays, NoRecord{}, media);
    }
}

/// Sets `shares` to the steps at which rays that have left the lens end in the pixels from which they came, and
/// `passed` to what the lens passes on at their wavelengths. `kicks`[lane]: by which diffraction moves them, mm per nm.
template <LensKind lens_kind, bool coated, int N, class Kicks>
REALCAM_HD inline void find_shares(const CameraView& camera, const SampleBlock<N>& block,
                                   const LensRays<float, N>& left, const Kicks& kicks, const float (&place)[N],
                                   std::int32_t (&shares)[N], float (&passed)[kSharedWavelengths][N]) {
    const DispersionView& view = camera.dispersion;
    LensView<float> to_film = camera.lens;
    to_film.surfaces = view.film_surfaces;
    for (int step = 1; step < kSharedWavelengths; ++step) {
        LensRays<float, N> back;
        Lanes<float, N> nm, variable;
        REALCAM_LANES
        for (int i = 0; i < N; ++i) {
            back.origin.set(i, left.origin[i]);
            back.direction.set(i, -left.direction[i]);
            back.status[i] = left.status[i];
            nm[i] = wavelength_at(view, shared_place(view, place[i], step));
            variable[i] = view.variable.at(nm[i]);
        }
        trace_dispersed<lens_kind, coated>(to_film, back, view.to_film, camera.coatings.to_film, variable,
                                           passed[step]);
        REALCAM_LANES
        for (int i = 0; i < N; ++i) {
            const Vec3f o = back.origin[i], d = back.direction[i];
            const float way = quotient(camera.film_distance - o.z, d.z);
            Vec2f film = {o.x + way * d.x, o.y + way * d.y};
            if constexpr (!std::is_same_v<Kicks, NoKicks>)
                film = {film.x + nm[i] * kicks[i].x, film.y + nm[i] * kicks[i].y};
            const bool is_shared = (back.status[i] == 0) & lies_in_pixel(camera, block, i, film);
            shares[i] |= select(is_shared, 1 << step, 0);
        }
    }
}

}  // namespace dispersed_rays_detail

/// A wavelength for each sample, stratified over those of its pixel, for which alone it counts so far.
template <int N>
REALCAM_INLINE void draw_wavelengths(const DispersionView& view, const SampleBlock<N>& block,
                                     SampleWavelengths<N>& wavelengths) {
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        wavelengths.place[i] = block.random(i, dimension::time).y * static_cast<float>(view.cell_count);
        wavelengths.shares[i] = 1;
    }
    REALCAM_LANES
    for (int i = 0; i < N; ++i) wavelengths.nm[i] = wavelength_at(view, wavelengths.place[i]);
}

/// generate_rays_from of a full lens, for samples that have a wavelength each. Finds for which others they count
/// (film_color). `coated`: with what the lens passes on.
template <LensKind lens_kind, bool coated, int N, class Points, class Kicks>
REALCAM_HD inline void generate_dispersed_rays_from(const CameraView& camera, const SampleBlock<N>& block,
                                                    const Points& film, const Kicks& kicks,
                                                    SampleWavelengths<N>& wavelengths, CameraRays<N>& rays) {
    using namespace dispersed_rays_detail;
    const DispersionView& view = camera.dispersion;
    Lanes<float, N> variable;
    REALCAM_LANES
    for (int i = 0; i < N; ++i) variable[i] = view.variable.at(wavelengths.nm[i]);
    LensRays<float, N> inside;
    start_lens_rays(camera, block, film, inside, rays);
    trace_dispersed<lens_kind, coated>(camera.lens, inside, view.to_scene, camera.coatings.to_scene, variable,
                                       wavelengths.passed[0]);
    if (view.cell_count > 1)
        find_shares<lens_kind, coated>(camera, block, inside, kicks, wavelengths.place, wavelengths.shares,
                                       wavelengths.passed);
    place_lens_rays(camera, inside, rays);
}

/// generate_rays of a full lens with dispersion: each ray has a wavelength of its own. `coated`: with what the lens
/// passes on.
template <LensKind lens_kind = LensKind::any, bool coated = false, int N>
REALCAM_HD inline void generate_dispersed_rays(const CameraView& camera, const SampleBlock<N>& block,
                                               SampleWavelengths<N>& wavelengths, CameraRays<N>& rays) {
    draw_wavelengths(camera.dispersion, block, wavelengths);
    generate_dispersed_rays_from<lens_kind, coated>(camera, block, PixelPoints<N>{camera, block}, NoKicks{},
                                                    wavelengths, rays);
}

}  // namespace REALCAM_NAMESPACE
