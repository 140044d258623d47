#pragma once
#include <cmath>
#include <optional>

#include "camera.hpp"
#include "field_of_view.hpp"

namespace REALCAM_NAMESPACE {

/// Angle to the axis, in front of the lens, of what the camera's model shows that far from the middle of the picture,
/// radians. Where the film is larger than the image of a full lens: that of the image's edge.
inline double picture_angle(const Camera& camera, double image_height_mm) {
    const LensSystem& lens = camera.lens;
    if (has_real_pupil(camera.model) || camera.model == CameraModel::mapped_lens)
        return widest_field_angle(lens, image_height_mm);
    camera_detail::validate_ideal(lens, camera.model);
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    if (camera.model != CameraModel::thick_lens)
        return std::atan(image_height_mm / static_cast<double>(camera_detail::thin_lens_of(lens, data).image_distance));
    // The ray through the middle of the exit pupil, from the last vertex to the front one.
    const ThickLens thick = camera_detail::thick_lens_of(lens, data);
    const double slope = image_height_mm / static_cast<double>(thick.exit_pupil_distance);
    const double height = image_height_mm - lens.film_distance * slope;
    return std::fabs(std::atan(static_cast<double>(thick.A) * slope - static_cast<double>(thick.C) * height));
}

/// From edge to edge of the picture, and from corner to corner, radians.
struct FieldOfView {
    double horizontal, vertical, diagonal;
};

/// Throws InputError where the camera's model has no place for its lens.
inline FieldOfView field_of_view(const Camera& camera) {
    const double width = camera.film.width_mm, height = camera.film.height_mm;
    return {2 * picture_angle(camera, 0.5 * width), 2 * picture_angle(camera, 0.5 * height),
            2 * picture_angle(camera, 0.5 * std::hypot(width, height))};
}

/// The middle of the paraxial entrance pupil in the scene, metres: where lines from the scene to the camera meet. None
/// where it lies at infinity.
inline std::optional<Vec3d> entrance_pupil_position_m(const Camera& camera) {
    const LensSystem& lens = camera.lens;
    const double pupil_mm = first_order(lens, lens.wavelength_nm).entrance_pupil_position;
    if (!std::isfinite(pupil_mm)) return std::nullopt;
    const Vec3d backward = camera_detail::axes_of(camera.pose).backward;
    return camera.pose.position_m - (0.001 * (lens.film_position() - pupil_mm)) * backward;
}

}  // namespace REALCAM_NAMESPACE
