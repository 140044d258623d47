#include "picture_angle.hpp"

#include <cmath>

#include "../math/hypotenuse.hpp"
#include "pinhole_camera.hpp"

namespace realcam {

double picture_angle(const Camera& camera, double image_height_mm) {
    const LensSystem lens = centred(camera.lens);
    if (has_real_pupil(camera.model) || camera.model == CameraModel::mapped_lens)
        return widest_field_angle(lens, image_height_mm);
    camera_detail::validate_ideal(lens, camera.model);
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    if (camera.model != CameraModel::thick_lens)
        return std::atan(image_height_mm / static_cast<double>(camera_detail::thin_lens_of(lens, data).image_distance));
    // Chief ray through the centre of the exit pupil, from the last vertex to the front one.
    const ThickLens thick = camera_detail::thick_lens_of(lens, data);
    const double slope = image_height_mm / static_cast<double>(thick.exit_pupil_distance);
    const double height = image_height_mm - lens.film_distance * slope;
    return std::fabs(std::atan(static_cast<double>(thick.A) * slope - static_cast<double>(thick.C) * height));
}

FieldOfView field_of_view(const Camera& camera) {
    const double x = 0.5 * camera.film.width_mm, y = 0.5 * camera.film.height_mm;
    const double right = std::fabs(camera.film.shift_mm.x), up = std::fabs(camera.film.shift_mm.y);
    // Angle between the film point farthest from the axis and the opposite one, which may lie on the same side.
    const auto between = [&](double far, double opposite) {
        const double angle = picture_angle(camera, far);
        return opposite == far ? 2 * angle
                               : angle + std::copysign(picture_angle(camera, std::fabs(opposite)), opposite);
    };
    const double beyond = (x + right) * (x - right) + (y + up) * (y - up);
    return {between(x + right, x - right), between(y + up, y - up),
            between(hypotenuse(x + right, y + up), std::copysign(hypotenuse(x - right, y - up), beyond))};
}

std::optional<Vec3d> entrance_pupil_position_m(const Camera& camera) {
    const LensSystem& lens = camera.lens;
    if (!lens.is_rotational()) {
        const std::optional<PinholeCamera> pinhole = pinhole_camera(camera, camera.pose);
        return pinhole ? std::optional(pinhole->centre_m) : std::nullopt;
    }
    const double pupil_mm = first_order(lens, lens.wavelength_nm).entrance_pupil_position;
    if (!std::isfinite(pupil_mm)) return std::nullopt;
    const Vec3d backward = camera_detail::axes_of(camera.pose).backward;
    return camera.pose.position_m - (0.001 * (lens.film_position() - pupil_mm)) * backward;
}

Vec3d film_centre_m(const Camera& camera) {
    const camera_detail::Axes axes = camera_detail::axes_of(camera.pose);
    const Vec2<double> shift = camera.film.shift_mm;
    // The image on the film is inverted in both directions.
    return camera.pose.position_m - (0.001 * shift.x) * axes.right - (0.001 * shift.y) * axes.up;
}

}  // namespace realcam
