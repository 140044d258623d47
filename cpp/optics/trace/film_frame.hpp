#pragma once
#include "lens_path.hpp"

namespace REALCAM_NAMESPACE {

/// The frame of the film, as seen from the lens frame: its vertex in the origin, and light comes with growing z.
Affine<double> film_frame(const LensSystem& lens);

/// Between the film's frame, where the film stands at film_distance, and the frame of a camera: its axes are the
/// lens's, and its z axis goes through the middle of the film, whose z is camera_film_position(). For a centred lens
/// both are the lens frame, and nothing is said.
PathEnds film_path_ends(const LensSystem& lens, LightDirection direction);

/// Of the film, from the plane of the front vertex along the lens's axis, mm.
double camera_film_position(const LensSystem& lens);

}  // namespace REALCAM_NAMESPACE
