#pragma once
#include <optional>

#include "../../optics/prescription/lens_system.hpp"
#include "../../platform.hpp"
#include "../film/camera.hpp"

namespace REALCAM_NAMESPACE {

// Angles of view, the centre of projection, and the pinhole model of a camera.

/// Angle to the axis, in front of the lens, of the light that reaches the film at `image_height_mm` from the axis,
/// radians: the mean direction of real meridional rays or, if few of those traced pass the stop, the direction of the
/// chief ray. NaN if no ray from there passes the lens.
double field_angle(const LensSystem& lens, double image_height_mm);

/// field_angle at the largest height, in steps of 2%, that receives light: a film may be larger than the lens's image.
/// 0 if no height does.
double widest_field_angle(const LensSystem& lens, double image_height_mm);

/// Field angle in front of the lens, radians, of light that the camera's model images at `image_height_mm` from the
/// axis. Beyond the image of a full lens: the field angle at the edge of the image.
double picture_angle(const Camera& camera, double image_height_mm);

/// Field of view from edge to edge of the picture, and from corner to corner, radians. For a shifted film, the angles
/// are in the planes of the axis, and between the two corners farthest from each other on both sides of it.
struct FieldOfView {
    double horizontal, vertical, diagonal;
};

/// Throws InputError if the camera's model cannot represent its lens.
FieldOfView field_of_view(const Camera& camera);

/// Centre of the paraxial entrance pupil in the scene, metres: the centre of projection. Returns std::nullopt if it
/// lies at infinity.
std::optional<Vec3d> entrance_pupil_position_m(const Camera& camera);

/// Centre of the film in the scene, metres: Pose::position_m displaced by Film::shift_mm.
Vec3d film_centre_m(const Camera& camera);

/// Central projection of a lens, mm: light at a small angle a to the axis through the centre of the entrance pupil
/// reaches the film at image_distance * tan(a), at any object distance.
struct CentralLens {
    double position;        ///< centre of the entrance pupil, from the front vertex; may be infinite
    double image_distance;  ///< the focal length if the lens is focused at infinity
};

/// Pinhole model of a camera: pixel = K (R p + t) up to scale, with p in the scene, metres. Axes of computer vision: x
/// right, y down, z forward from the centre of projection, the centre of the entrance pupil. Pixel coordinates start at
/// the upper left corner of the picture, so the centre of the first pixel is (0.5, 0.5).
struct PinholeCamera {
    double focal_x, focal_y, centre_x, centre_y;  ///< K, pixels
    /// Off-diagonal elements of K: column by y / z, and row by x / z. Non-zero only for lenses whose meridians are not
    /// along the film's axes.
    double column_by_y = 0, row_by_x = 0;
    Vec3d right, down, forward;  ///< rows of R
    Vec3d translation_m;  ///< t
    Vec3d centre_m;  ///< centre of projection, in the scene
};

/// Centre of projection of a camera, in the axes of the camera (x right, y up, z backward), mm from the centre of the
/// unshifted film: the centre of the lens's entrance pupil, or its front vertex if the pupil lies at infinity.
Vec3d centre_of_projection_mm(const Camera& camera);

/// Pinhole model of a camera with this pose. Returns std::nullopt if the entrance pupil of the lens lies at infinity:
/// it has no centre of projection.
std::optional<PinholeCamera> pinhole_camera(const Camera& camera, const Pose& pose);

/// Pose of the camera at the middle of its exposure.
Pose pose_at_mid_exposure(const Camera& camera);

}  // namespace REALCAM_NAMESPACE
