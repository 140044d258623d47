#pragma once
#include "exposed_rays.hpp"

namespace REALCAM_NAMESPACE {

/// Largest number of pupil points that are tried before a pixel counts as dark. Their spacing is two percent of the
/// pupil's radius.
inline constexpr int kPupilTrials = 2048;

namespace pixel_centre_rays_detail {

/// Point of Vogel's sunflower spiral, in units of the half sizes of the pupil's box: uniformly spread, in order of
/// increasing radius. Point 0 is the centre.
REALCAM_INLINE Vec2f spiral_point(int index) {
    constexpr float kGoldenTurn = 0.381966011f;  // golden angle in turns: (3 - sqrt(5)) / 2
    const float turns = static_cast<float>(index) * kGoldenTurn;
    const Vec2f azimuth = cos_sin_of_turn(turns - std::floor(turns));
    // Radius up to sqrt(2), because a pupil with blades may fill the corners of the box.
    const float radius = 1.4142136f * std::sqrt(static_cast<float>(index) / static_cast<float>(kPupilTrials));
    return {radius * azimuth.x, radius * azimuth.y};
}

/// Optical direction from a film point (mm) to a point in the box around its pupil.
template <class Map>
REALCAM_INLINE Vec3f direction_to(const PupilTableView<Map>& pupil, Vec2f film, Vec2f pupil_point) {
    const PupilLookup at(pupil, film.x, film.y);
    const Vec2f d = at.from_box(pupil_point), cosines = at.to_film(d);
    return {cosines.x, cosines.y, -sqrt_or_zero(pupil.index_squared - d.x * d.x - d.y * d.y)};
}

REALCAM_INLINE Vec3f direction_to(const CameraView& camera, Vec2f film, Vec2f pupil_point) {
    if (camera.pupil_grid.nodes) return direction_to(camera.pupil_grid, film, pupil_point);
    return direction_to(camera.pupil, film, pupil_point);
}

/// False if no light can reach a film point.
REALCAM_INLINE bool may_be_lit(const CameraView& camera, Vec2f film) {
    if (camera.pupil_grid.nodes) return PupilLookup(camera.pupil_grid, film.x, film.y).may_be_lit();
    return PupilLookup(camera.pupil, film.x, film.y).may_be_lit();
}

/// Index of the next point, from `first` on, that lies in the tabulated pupil; kPupilTrials if there is none.
REALCAM_INLINE int next_trial(const CameraView& camera, Vec2f film, int first) {
    for (int k = first; k < kPupilTrials; ++k) {
        const Vec3f direction = direction_to(camera, film, spiral_point(k));
        if (direction.z < 0.0f && camera_pupil_pdf(camera, film, direction) > 0.0f) return k;
    }
    return kPupilTrials;
}

/// Pixel-centre rays at the start of the exposure of a camera with a real pupil.
template <int N>
REALCAM_HD inline void lens_rays(const CameraView& camera, const SampleBlock<N>& block, CameraRays<N>& rays) {
    LensRays<float, N> inside;
    Lanes<std::int32_t, N> trial;
    int searching = 0;
    for (int i = 0; i < N; ++i) {
        const Vec2f film = film_point(camera, block.column[i], block.row[i], {0.5f, 0.5f});
        // The centre is tried even if it lies outside the tabulated pupil, which is a polygon.
        trial[i] = block.used[i] && may_be_lit(camera, film) ? 0 : kPupilTrials;
        rays.passed[i] = 0;
        rays.sampled[i] = block.used[i];
        set_camera_ray(camera, rays, i, {}, false);
        searching |= trial[i] < kPupilTrials;
    }
    while (searching) {
        searching = 0;
        for (int i = 0; i < N; ++i) {
            const Vec2f film = film_point(camera, block.column[i], block.row[i], {0.5f, 0.5f});
            const bool tries = !rays.passed[i] && trial[i] < kPupilTrials;
            const Vec3f direction = direction_to(camera, film, spiral_point(tries ? trial[i] : 0));
            const FilmSurface<float> surface = film_surface(camera);
            inside.origin.set(i, surface.point(film));
            inside.direction.set(i, surface.direction(film, direction));
            inside.status[i] = tries ? 0 : static_cast<int>(RayStatus::vignetted);
        }
        if (camera.polynomial.disc_count > 0)
            trace_polynomial(camera.polynomial, camera.film_distance, inside);
        else
            trace_lens(camera.lens, inside);
        for (int i = 0; i < N; ++i) {
            if (rays.passed[i] || trial[i] == kPupilTrials) continue;
            if (inside.status[i] == 0) {
                set_camera_ray(camera, rays, i, {inside.origin[i], normalized(inside.direction[i]), 1.0f}, true);
                rays.passed[i] = 1;
                continue;
            }
            const Vec2f film = film_point(camera, block.column[i], block.row[i], {0.5f, 0.5f});
            trial[i] = next_trial(camera, film, trial[i] + 1);
            searching |= trial[i] < kPupilTrials;
        }
    }
}

/// Pixel-centre rays at the start of the exposure of any camera.
template <int N>
REALCAM_HD inline void rays_at_start(const CameraView& camera, const SampleBlock<N>& block, CameraRays<N>& rays) {
    if (has_real_pupil(camera.model)) {
        lens_rays(camera, block, rays);
        return;
    }
    for (int i = 0; i < N; ++i) {
        LensFrameRay ray = ideal_chief_ray(camera, film_point(camera, block.column[i], block.row[i], {0.5f, 0.5f}));
        ray.weight = 1.0f;
        set_camera_ray(camera, rays, i, ray, block.used[i] != 0);
        rays.sampled[i] = rays.passed[i] = block.used[i];
    }
}

/// Centre of each lane's pixel on the film.
template <int N>
struct PixelCentres {
    const CameraView& camera;
    const SampleBlock<N>& block;

    REALCAM_INLINE Vec2f operator[](int lane) const {
        return film_point(camera, block.column[lane], block.row[lane], {0.5f, 0.5f});
    }
};

}  // namespace pixel_centre_rays_detail

/// Pixel-centre rays: from the centre of each pixel through the centre of the pupil as seen from there. If that ray is
/// blocked (mirror lenses have a central obstruction), the nearest ray in the pupil that passes replaces it. Weights
/// are 1, or 0 if no ray passes. `times`: the middle of the exposure of each pixel. Streams and samples of the block
/// are not used.
template <int N>
REALCAM_HD inline void pixel_centre_rays(const CameraView& camera, const SampleBlock<N>& block, CameraRays<N>& rays,
                                         float (&times)[N]) {
    using namespace pixel_centre_rays_detail;
    rays_at_start(camera, block, rays);
    if (camera.bundles.nodes) {
        move_bundles(camera, PixelCentres<N>{camera, block}, rays);
        for (int i = 0; i < N; ++i) rays.weight[i] = rays.weight[i] > 0.0f ? 1.0f : 0.0f;
    }
    set_times(camera, block, times, [](int) { return 0.5f; });
    move_rays(camera, times, rays);
}

}  // namespace REALCAM_NAMESPACE
