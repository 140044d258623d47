#pragma once
#include <optional>

#include "camera.hpp"

namespace REALCAM_NAMESPACE {

/// Central projection of a lens, mm: light at a small angle a to the axis through the centre of the entrance pupil
/// reaches the film at image_distance * tan(a), at any object distance.
struct CentralLens {
    double position;        ///< centre of the entrance pupil, from the front vertex; may be infinite
    double image_distance;  ///< the focal length if the lens is focused at infinity
};

/// Pixel = K (R p + t), with p in the scene. Axes of computer vision: x right, y down, z forward from the centre of
/// projection, the centre of the entrance pupil. Pixel coordinates start at the upper left corner of the picture, so
/// the centre of the first pixel is (0.5, 0.5).
struct PinholeCamera {
    double focal_x, focal_y, centre_x, centre_y;  ///< K, pixels
    /// Off-diagonal elements of K: column by y / z, and row by x / z. Non-zero only for lenses whose meridians are not
    /// along the film's axes.
    double column_by_y = 0, row_by_x = 0;
    Vec3d right, down, forward;  ///< rows of R
    Vec3d translation_m;  ///< t
    Vec3d centre_m;  ///< centre of projection, in the scene
};

/// Pinhole model of a camera with this pose. Returns std::nullopt if the entrance pupil of the lens lies at infinity:
/// it has no centre of projection.
std::optional<PinholeCamera> pinhole_camera(const Camera& camera, const Pose& pose);

/// Pose of the camera at the middle of its exposure.
Pose middle_pose(const Camera& camera);

}  // namespace REALCAM_NAMESPACE
