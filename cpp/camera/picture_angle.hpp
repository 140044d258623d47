#pragma once
#include <optional>

#include "camera.hpp"
#include "field_of_view.hpp"

namespace REALCAM_NAMESPACE {

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

}  // namespace REALCAM_NAMESPACE
