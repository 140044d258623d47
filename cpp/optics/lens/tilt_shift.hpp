#pragma once
#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// The whole lens moved before a film that stays where it is: the front of a camera with bellows, or a lens with a
/// tilt or a shift of its own. The lens frame, and with it the camera's pose, stays that of the film. `move`: of the
/// lens, as seen from its frame. It is turned about the point that lies `pivot` mm in front of the film's middle, on
/// the axis through it. Throws InputError where the first surface is moved alone, and LensFileError where the lens
/// cannot be built.
LensSystem with_lens_moved(const LensSystem& lens, const SurfacePlacement& move, double pivot = 0);

/// The lens without what moves all of it before the film, and with the film in its place on the last axis.
LensSystem without_move(LensSystem lens);

}  // namespace REALCAM_NAMESPACE
