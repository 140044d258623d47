#pragma once
#include "generate_rays.hpp"

namespace REALCAM_NAMESPACE {

// One wavelength a sample would be noisy: a film has three channels, and each would see a third of the samples. But a
// ray that has left the lens would often have come from the same pixel, if from another point of it, at another
// wavelength too. So it is taken back to the film at two more, a third of the cells apart each. Where it ends in its
// pixel, that wavelength could have drawn it, with the same density, because film and scene measure rays alike (the
// optical invariant): the sample counts for all that could, in equal parts (the balance heuristic of Veach and Guibas
// 1995). The three are the same whichever of them comes first, so that nothing is counted twice or left out.

namespace dispersed_rays_detail {

/// Sets `shares` to the steps at which rays that have left the lens end in the pixels from which they came.
template <LensKind lens_kind, int N>
REALCAM_HD inline void find_shares(const CameraView& camera, const SampleBlock<N>& block,
                                   const LensRays<float, N>& left, const float (&place)[N], std::int32_t (&shares)[N]) {
    const DispersionView& view = camera.dispersion;
    LensView<float> to_film = camera.lens;
    to_film.surfaces = view.film_surfaces;
    const float columns_per_mm = -0.5f * static_cast<float>(camera.width) / camera.film_half_width;
    const float rows_per_mm = 0.5f * static_cast<float>(camera.height) / camera.film_half_height;
    for (int step = 1; step < kSharedWavelengths; ++step) {
        LensRays<float, N> back;
        alignas(kLaneAlignment<float, N>) float variable[N];
        REALCAM_LANES
        for (int i = 0; i < N; ++i) {
            back.origin.set(i, left.origin[i]);
            back.direction.set(i, -left.direction[i]);
            back.status[i] = left.status[i];
            variable[i] = view.variable.at(wavelength_at(view, shared_place(view, place[i], step)));
        }
        trace_lens<lens_kind>(to_film, back, NoRecord{}, ManyWavelengths{view.to_film, variable});
        REALCAM_LANES
        for (int i = 0; i < N; ++i) {
            const Vec3f o = back.origin[i], d = back.direction[i];
            const float way = quotient(camera.film_distance - o.z, d.z);
            const Vec2f corner = film_point(camera, block.column[i], block.row[i], {0.0f, 0.0f});
            const float column = columns_per_mm * (o.x + way * d.x - corner.x),
                        row = rows_per_mm * (o.y + way * d.y - corner.y);
            const bool inside = (column >= 0.0f) & (column < 1.0f) & (row >= 0.0f) & (row < 1.0f);
            shares[i] |= select((back.status[i] == 0) & inside, 1 << step, 0);
        }
    }
}

}  // namespace dispersed_rays_detail

/// generate_rays of a full lens with dispersion: each ray has a wavelength of its own, which is stratified over the
/// samples of its pixel. `place`, `shares`: of the wavelengths for which the sample counts (film_color).
template <LensKind lens_kind = LensKind::any, int N>
REALCAM_HD inline void generate_dispersed_rays(const CameraView& camera, const SampleBlock<N>& block,
                                               float (&wavelength_nm)[N], float (&place)[N], std::int32_t (&shares)[N],
                                               CameraRays<N>& rays) {
    const DispersionView& view = camera.dispersion;
    alignas(kLaneAlignment<float, N>) float variable[N];
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        place[i] = block.random(i, dimension::time).y * static_cast<float>(view.cell_count);
        shares[i] = 1;
    }
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        wavelength_nm[i] = wavelength_at(view, place[i]);
        variable[i] = view.variable.at(wavelength_nm[i]);
    }
    LensRays<float, N> inside;
    start_lens_rays(camera, block, inside, rays);
    trace_lens<lens_kind>(camera.lens, inside, NoRecord{}, ManyWavelengths{view.to_scene, variable});
    if (view.cell_count > 1) dispersed_rays_detail::find_shares<lens_kind>(camera, block, inside, place, shares);
    place_lens_rays(camera, inside, rays);
}

}  // namespace REALCAM_NAMESPACE
