#pragma once
#include <cmath>
#include <optional>

#include "camera.hpp"

namespace REALCAM_NAMESPACE {

/// What a camera's lens is to computer vision, mm: light at a small angle a to the axis through the middle of the
/// entrance pupil meets the film at image_distance * tan(a), whatever the object's distance.
struct CentralLens {
    double position;        ///< of the middle of the entrance pupil, from the front vertex; may be infinite
    double image_distance;  ///< the focal length, for a lens that is focused at infinity
};

/// Of an ideal lens its own image distance. The film of a real one lies where its picture is sharpest, which is not
/// quite the paraxial focus: where the paraxial ray through the middle of the pupil meets it.
inline CentralLens central_lens(const LensSystem& lens, CameraModel model) {
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    if (model == CameraModel::pinhole || model == CameraModel::thin_lens)
        return {data.entrance_pupil_position, camera_detail::ideal_lens_of(lens, data).image_distance};
    const ParaxialRay chief = trace_paraxial(lens, lens.wavelength_nm, {-data.entrance_pupil_position, 1}, 0,
                                             static_cast<int>(lens.surfaces.size()));
    return {data.entrance_pupil_position, std::fabs(chief.height + lens.film_distance * chief.slope)};
}

/// Pixel = K (R p + t), p in the scene, in the axes of computer vision: x right, y down, z forward from the centre of
/// projection, which is the middle of the entrance pupil. Columns and rows count from the upper left corner of the
/// picture, so that the middle of the first pixel is (0.5, 0.5).
struct PinholeCamera {
    double focal_x, focal_y, centre_x, centre_y;  ///< K, pixels
    Vec3d right, down, forward;                   ///< the rows of R
    Vec3d translation_m;                          ///< t
    Vec3d centre_m;                               ///< of projection, in the scene
};

/// Of a camera with this pose. None for a lens whose entrance pupil lies at infinity: it has no centre of projection.
inline std::optional<PinholeCamera> pinhole_camera(const Camera& camera, const Pose& pose) {
    const CentralLens lens = central_lens(camera.lens, camera.model);
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

/// Where the camera is in the middle of its exposure.
inline Pose middle_pose(const Camera& camera) {
    const TimeInterval exposure = camera.exposure();
    return pose_at(camera, 0.5 * (exposure.begin_s + exposure.end_s));
}

}  // namespace REALCAM_NAMESPACE
