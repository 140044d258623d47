#pragma once
#include "lens_path.hpp"

namespace REALCAM_NAMESPACE {

/// Returns the frame of the film, in the lens frame: its origin is the film's vertex, and light arrives along +z.
Affine<double> film_frame(const LensSystem& lens);

/// Returns the frames in which the rays of a camera enter and leave a path in this direction. On the film's side that
/// is the frame of the film, shifted along its z axis such that the film lies at z = film_distance. On the scene's side
/// it is the camera frame: its axes are parallel to those of the lens frame, and its z axis passes through the film's
/// centre, whose z is camera_film_position(). For a centred lens both are the lens frame, and the ends are empty.
PathEnds film_path_ends(const LensSystem& lens, LightDirection direction);

/// Returns the position of the film's centre along the z axis of the lens frame, mm from the front vertex.
double camera_film_position(const LensSystem& lens);

}  // namespace REALCAM_NAMESPACE
