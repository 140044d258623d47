#pragma once
#include "lens_path.hpp"

namespace REALCAM_NAMESPACE {

/// Frame of the film in the lens frame: the origin is the film's vertex, and light arrives with growing z.
Affine<double> film_frame(const LensSystem& lens);

/// Path ends in the frame of the film, shifted such that the film stands at z = film_distance, and in the frame of the
/// camera: its axes are parallel to the lens's, and its z axis passes through the film's centre, whose z is
/// camera_film_position(). For a centred lens both are the lens frame, and the ends are empty.
PathEnds film_path_ends(const LensSystem& lens, LightDirection direction);

/// Position of the film along the lens's axis, from the plane of the front vertex, mm.
double camera_film_position(const LensSystem& lens);

}  // namespace REALCAM_NAMESPACE
