#pragma once
#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Returns the lens moved as a whole in front of a fixed film, like the front standard of a view camera or a tilt-shift
/// lens. The lens frame, and with it the camera's pose, remains that of the film. `move` is relative to the lens frame;
/// it rotates the lens about the point `pivot` mm in front of the film's centre, on the axis through it. Throws
/// InputError if the first surface is moved alone, and LensFileError if the lens cannot be built.
LensSystem with_lens_moved(const LensSystem& lens, const SurfacePlacement& move, double pivot = 0);

/// Returns the lens without the motion of the whole lens, and with the film centred on the last axis.
LensSystem without_move(LensSystem lens);

}  // namespace REALCAM_NAMESPACE
