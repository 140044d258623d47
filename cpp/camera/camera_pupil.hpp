#pragma once
#include "camera_view.hpp"

namespace REALCAM_NAMESPACE {

/// A ray from the film into the lens.
struct FilmRaySample {
    Vec3f origin;  ///< mm
    Vec3f direction;  ///< optical direction: length is the refractive index
    float weight;  ///< see PupilSample::weight
};

/// Film surface in front of a lens of any kind, also without rotational symmetry.
REALCAM_INLINE FilmSurface<float> film_surface(const CameraView& camera) {
    return {camera.film_distance, camera.film_curvature};
}

/// Samples a ray from a film point (mm) into the lens. `lens_kind`: LensKind::any, or the lens's own kind.
template <LensKind lens_kind>
REALCAM_INLINE FilmRaySample sample_film_ray(const CameraView& camera, Vec2f film, Vec2f u) {
    if constexpr (lens_kind == LensKind::any) {
        if (camera.pupil_grid.nodes) {
            const PupilSample pupil = sample_pupil(camera.pupil_grid, film.x, film.y, u.x, u.y);
            const FilmSurface<float> surface = film_surface(camera);
            return {surface.point(film), surface.direction(film, pupil.direction), pupil.weight};
        }
    }
    const PupilSample pupil = sample_pupil(camera.pupil, film.x, film.y, u.x, u.y);
    return {{film.x, film.y, camera.film_distance}, pupil.direction, pupil.weight};
}

/// Intersection of a ray that has left the lens with the film, mm.
template <LensKind lens_kind>
REALCAM_INLINE Vec2f landing_on_film(const CameraView& camera, Vec3f origin, Vec3f direction) {
    if constexpr (lens_kind == LensKind::any) return film_surface(camera).landing(origin, direction);
    return crossing_at(camera.film_distance, origin, direction);
}

/// Irradiance of a pixel for unit flux arriving at a film point, 1/mm^2. A pixel's irradiance is the mean, over x and y
/// of its film samples, of the irradiance on the film's surface, whose area is larger than the pixel's where it is
/// inclined.
template <LensKind lens_kind>
REALCAM_INLINE float irradiance_of_flux(const CameraView& camera, Vec2f film) {
    const float pixel_area = 4.0f * camera.film_half_width * camera.film_half_height /
                             (static_cast<float>(camera.width) * static_cast<float>(camera.height));
    if constexpr (lens_kind == LensKind::any) return film_surface(camera).cosine(film) / pixel_area;
    return 1.0f / pixel_area;
}

/// Density of a direction sampled by sample_film_ray, per unit area of optical direction cosines.
REALCAM_INLINE float camera_pupil_pdf(const CameraView& camera, Vec2f film, Vec3f direction) {
    if (camera.pupil_grid.nodes) return pupil_pdf(camera.pupil_grid, film.x, film.y, direction.x, direction.y);
    return pupil_pdf(camera.pupil, film.x, film.y, direction.x, direction.y);
}

}  // namespace REALCAM_NAMESPACE
