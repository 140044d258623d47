#pragma once
#include <optional>

#include "camera.hpp"

namespace REALCAM_NAMESPACE {

/// What a camera's lens is to computer vision, mm: light at a small angle a to the axis through the middle of the
/// entrance pupil meets the film at image_distance * tan(a), whatever the object's distance.
struct CentralLens {
    double position;        ///< of the middle of the entrance pupil, from the front vertex; may be infinite
    double image_distance;  ///< the focal length, for a lens that is focused at infinity
};

/// Pixel = K (R p + t), p in the scene, in the axes of computer vision: x right, y down, z forward from the centre of
/// projection, which is the middle of the entrance pupil. Columns and rows count from the upper left corner of the
/// picture, so that the middle of the first pixel is (0.5, 0.5).
struct PinholeCamera {
    double focal_x, focal_y, centre_x, centre_y;  ///< K, pixels
    /// The others of K: column by y / z, and row by x / z. Of lenses alone whose meridians do not lie in the film's
    /// axes.
    double column_by_y = 0, row_by_x = 0;
    Vec3d right, down, forward;  ///< the rows of R
    Vec3d translation_m;  ///< t
    Vec3d centre_m;  ///< of projection, in the scene
};

/// The pinhole of a camera with this pose. There is none for a lens whose entrance pupil lies at infinity: it has no
/// centre of projection.
std::optional<PinholeCamera> pinhole_camera(const Camera& camera, const Pose& pose);

/// Where the camera is in the middle of its exposure.
Pose middle_pose(const Camera& camera);

}  // namespace REALCAM_NAMESPACE
