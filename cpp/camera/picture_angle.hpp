#pragma once
#include <optional>

#include "camera.hpp"
#include "field_of_view.hpp"

namespace REALCAM_NAMESPACE {

/// Angle to the axis, in front of the lens, of what the camera's model shows that far from the middle of the picture,
/// radians. Where the film is larger than the image of a full lens: that of the image's edge.
double picture_angle(const Camera& camera, double image_height_mm);

/// Angles from edge to edge of the picture, and from corner to corner, radians. On a shifted film they are in the
/// planes of the axis, and between the two corners farthest from each other on both sides of it.
struct FieldOfView {
    double horizontal, vertical, diagonal;
};

/// Throws InputError where the camera's model has no place for its lens.
FieldOfView field_of_view(const Camera& camera);

/// The middle of the paraxial entrance pupil in the scene, metres: where lines from the scene to the camera meet. None
/// where it lies at infinity.
std::optional<Vec3d> entrance_pupil_position_m(const Camera& camera);

/// The middle of the film in the scene, metres: Pose::position_m but for Film::shift_mm.
Vec3d film_centre_m(const Camera& camera);

}  // namespace REALCAM_NAMESPACE
