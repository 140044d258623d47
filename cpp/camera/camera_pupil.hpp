#pragma once
#include "camera_view.hpp"

namespace REALCAM_NAMESPACE {

/// A ray from the film into the lens.
struct FilmRaySample {
    Vec3f origin;  ///< mm
    Vec3f direction;  ///< optical
    float weight;  ///< as of a PupilSample
};

/// The film of a lens that need not be one of revolution.
REALCAM_INLINE FilmSurface<float> film_surface(const CameraView& camera) {
    return {camera.film_distance, camera.film_curvature};
}

/// Chooses a ray from a film point (mm). `lens_kind`: any, or the lens's own.
template <LensKind lens_kind>
REALCAM_INLINE FilmRaySample sample_film_ray(const CameraView& camera, Vec2f film, Vec2f u) {
    if constexpr (lens_kind == LensKind::any) {
        if (camera.pupil_grid.nodes) {
            const PupilSample pupil = sample_pupil(camera.pupil_grid, film.x, film.y, u.x, u.y);
            const FilmSurface<float> surface = film_surface(camera);
            return {surface.place(film), surface.direction(film, pupil.direction), pupil.weight};
        }
    }
    const PupilSample pupil = sample_pupil(camera.pupil, film.x, film.y, u.x, u.y);
    return {{film.x, film.y, camera.film_distance}, pupil.direction, pupil.weight};
}

/// Where a ray from the lens meets the film, mm.
template <LensKind lens_kind>
REALCAM_INLINE Vec2f landing_on_film(const CameraView& camera, Vec3f origin, Vec3f direction) {
    if constexpr (lens_kind == LensKind::any) return film_surface(camera).landing(origin, direction);
    return crossing_at(camera.film_distance, origin, direction);
}

/// Irradiance of a pixel for unit flux that arrives at a film point, 1/mm^2. A pixel's irradiance is the mean over x
/// and y, in which film samples are uniform, of the irradiance on the film's surface. On a slope, the surface is larger
/// than the pixel.
template <LensKind lens_kind>
REALCAM_INLINE float irradiance_of_flux(const CameraView& camera, Vec2f film) {
    const float pixel_area = 4.0f * camera.film_half_width * camera.film_half_height /
                             (static_cast<float>(camera.width) * static_cast<float>(camera.height));
    if constexpr (lens_kind == LensKind::any) return film_surface(camera).cosine(film) / pixel_area;
    return 1.0f / pixel_area;
}

/// Density of such a direction, per unit of area of direction cosines.
REALCAM_INLINE float camera_pupil_pdf(const CameraView& camera, Vec2f film, Vec3f direction) {
    if (camera.pupil_grid.nodes) return pupil_pdf(camera.pupil_grid, film.x, film.y, direction.x, direction.y);
    return pupil_pdf(camera.pupil, film.x, film.y, direction.x, direction.y);
}

}  // namespace REALCAM_NAMESPACE
