#pragma once
#include "exposed_rays.hpp"

namespace REALCAM_NAMESPACE {

/// How many places in the pupil are tried before a pixel counts as dark: at two percent of its radius from the next.
inline constexpr int kMiddlePlaces = 2048;

namespace middle_rays_detail {

/// Places in the unit disc, each farther out than the one before, and evenly spread (Vogel's spiral). The first is the
/// middle.
REALCAM_INLINE Vec2f spiral(int index) {
    constexpr float kGoldenTurn = 0.381966011f;
    const float turns = static_cast<float>(index) * kGoldenTurn;
    const Vec2f azimuth = cos_sin_of_turn(turns - std::floor(turns));
    // The corners of the box count: a pupil with blades may fill them.
    const float reach = 1.4142136f * std::sqrt(static_cast<float>(index) / static_cast<float>(kMiddlePlaces));
    return {reach * azimuth.x, reach * azimuth.y};
}

/// The optical direction with these cosines.
REALCAM_INLINE Vec3f optical_direction(float l, float m, float index_squared) {
    return {l, m, -sqrt_or_zero(index_squared - l * l - m * m)};
}

/// The optical direction from a film point to a place in the box around its pupil.
REALCAM_INLINE Vec3f direction_to(const CameraView& camera, Vec2f film, Vec2f place) {
    if (camera.pupil_grid.nodes) {
        const PupilGridPlace at = pupil_grid_place(camera.pupil_grid, film.x, film.y);
        return optical_direction(at.sign_l * (at.box.centre_l + at.box.half_width * place.x),
                                 at.sign_m * (at.box.centre_m + at.box.half_height * place.y),
                                 camera.pupil_grid.index_squared);
    }
    const PupilRowPosition row = pupil_row_position(camera.pupil, film.x, film.y);
    const float l = row.centre + row.half_width * place.x, m = row.half_height * place.y;
    const Vec3f on_x_axis = optical_direction(l, m, camera.pupil.index_squared);
    return {l * row.cos - m * row.sin, l * row.sin + m * row.cos, on_x_axis.z};
}

/// Whether light may arrive at a film point at all.
REALCAM_INLINE bool may_be_lit(const CameraView& camera, Vec2f film) {
    if (camera.pupil_grid.nodes)
        return camera.pupil_grid.cells[pupil_grid_place(camera.pupil_grid, film.x, film.y).cell].upper_weight > 0.0f;
    return pupil_row_position(camera.pupil, film.x, film.y).lit > 0.0f;
}

/// The next place, from `first` on, that lies in the pupil by its table; kMiddlePlaces where there is none.
REALCAM_INLINE int next_place(const CameraView& camera, Vec2f film, int first) {
    for (int k = first; k < kMiddlePlaces; ++k) {
        const Vec3f direction = direction_to(camera, film, spiral(k));
        if (direction.z < 0.0f && camera_pupil_pdf(camera, film, direction) > 0.0f) return k;
    }
    return kMiddlePlaces;
}

template <int N>
REALCAM_HD inline void lens_rays(const CameraView& camera, const SampleBlock<N>& block, CameraRays<N>& rays) {
    LensRays<float, N> inside;
    Lanes<std::int32_t, N> place;
    int searching = 0;
    for (int i = 0; i < N; ++i) {
        const Vec2f film = film_point(camera, block.column[i], block.row[i], {0.5f, 0.5f});
        // The pupil's own middle is tried even where the table leaves it out: the table is a polygon.
        place[i] = block.used[i] && may_be_lit(camera, film) ? 0 : kMiddlePlaces;
        rays.passed[i] = 0;
        rays.sampled[i] = block.used[i];
        place_ray(camera, rays, i, {}, false);
        searching |= place[i] < kMiddlePlaces;
    }
    while (searching) {
        searching = 0;
        for (int i = 0; i < N; ++i) {
            const Vec2f film = film_point(camera, block.column[i], block.row[i], {0.5f, 0.5f});
            const bool tries = !rays.passed[i] && place[i] < kMiddlePlaces;
            const Vec3f direction = direction_to(camera, film, spiral(tries ? place[i] : 0));
            const FilmSurface<float> surface = film_surface(camera);
            inside.origin.set(i, surface.place(film));
            inside.direction.set(i, surface.direction(film, direction));
            inside.status[i] = tries ? 0 : static_cast<int>(RayStatus::vignetted);
        }
        trace_lens(camera.lens, inside);
        for (int i = 0; i < N; ++i) {
            if (rays.passed[i] || place[i] == kMiddlePlaces) continue;
            if (inside.status[i] == 0) {
                place_ray(camera, rays, i, {inside.origin[i], normalized(inside.direction[i]), 1.0f}, true);
                rays.passed[i] = 1;
                continue;
            }
            const Vec2f film = film_point(camera, block.column[i], block.row[i], {0.5f, 0.5f});
            place[i] = next_place(camera, film, place[i] + 1);
            searching |= place[i] < kMiddlePlaces;
        }
    }
}

template <int N>
REALCAM_HD inline void still_rays(const CameraView& camera, const SampleBlock<N>& block, CameraRays<N>& rays) {
    if (has_real_pupil(camera.model)) {
        lens_rays(camera, block, rays);
        return;
    }
    for (int i = 0; i < N; ++i) {
        const Vec2f film = film_point(camera, block.column[i], block.row[i], {0.5f, 0.5f}), middle = {0.0f, 0.0f};
        LensFrameRay ray = camera.model == CameraModel::thick_lens    ? thick_lens_ray(camera, film, middle)
                           : camera.model == CameraModel::mapped_lens ? mapped_lens_ray(camera, film, middle)
                                                                      : thin_lens_ray(camera, film, middle, 0.0f);
        ray.weight = 1.0f;
        place_ray(camera, rays, i, ray, block.used[i] != 0);
        rays.sampled[i] = rays.passed[i] = block.used[i];
    }
}

}  // namespace middle_rays_detail

/// The ray from the middle of each pixel through the middle of the pupil as it is seen from there. Where that ray is
/// blocked (mirror lenses have a hole there), it is the nearest to it in the pupil that passes. Weights are 1, and 0
/// where none passes. `times`: in the middle of the exposure of each pixel. The streams and samples of the block are
/// not used.
template <int N>
REALCAM_HD inline void middle_rays(const CameraView& camera, const SampleBlock<N>& block, CameraRays<N>& rays,
                                   float (&times)[N]) {
    middle_rays_detail::still_rays(camera, block, rays);
    set_times(camera, block, times, [](int) { return 0.5f; });
    move_rays(camera, times, rays);
}

}  // namespace REALCAM_NAMESPACE
