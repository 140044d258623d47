#include "pinhole_camera.hpp"

#include <cmath>

namespace realcam {

namespace {

/// An ideal lens has its own image distance. The film of a real lens lies where its picture is sharpest, which is not
/// quite the paraxial focus. Its image distance follows from the paraxial ray through the middle of the pupil.
CentralLens central_lens(const LensSystem& lens, CameraModel model) {
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    if (model == CameraModel::pinhole || model == CameraModel::thin_lens)
        return {data.entrance_pupil_position, camera_detail::ideal_lens_of(lens, data).image_distance};
    const ParaxialRay chief = trace_paraxial(lens, lens.wavelength_nm, {-data.entrance_pupil_position, 1}, 0,
                                             static_cast<int>(lens.surfaces.size()));
    return {data.entrance_pupil_position, std::fabs(chief.height + lens.film_distance * chief.slope)};
}

}  // namespace

std::optional<PinholeCamera> pinhole_camera(const Camera& camera, const Pose& pose) {
    const CentralLens lens = central_lens(centred(camera.lens), camera.model);
    if (!std::isfinite(lens.position) || !std::isfinite(lens.image_distance)) return std::nullopt;
    const Film& film = camera.film;
    PinholeCamera result{};
    result.focal_x = lens.image_distance * film.width / film.width_mm;
    result.focal_y = lens.image_distance * film.height / film.height_mm;
    const Vec2<double> axis = film.pixel_of({0, 0});
    result.centre_x = axis.x;
    result.centre_y = axis.y;
    const camera_detail::Axes axes = camera_detail::axes_of(pose);
    result.right = axes.right;
    result.down = -axes.up;
    result.forward = -axes.backward;
    result.centre_m = pose.position_m - (0.001 * (camera.lens.film_position() - lens.position)) * axes.backward;
    result.translation_m = {-dot(result.right, result.centre_m), -dot(result.down, result.centre_m),
                            -dot(result.forward, result.centre_m)};
    return result;
}

Pose middle_pose(const Camera& camera) {
    const TimeInterval exposure = camera.exposure();
    return pose_at(camera, 0.5 * (exposure.begin_s + exposure.end_s));
}

}  // namespace realcam
