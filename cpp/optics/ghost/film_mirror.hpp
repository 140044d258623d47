#pragma once
#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Returns the lens with its film appended as the last surface: a mirror with the film's curvature and placement, this
/// reflectance and a clear semi-diameter of `radius` mm. For light that the film reflects back into the lens.
LensSystem with_film_mirror(LensSystem lens, double reflectance, double radius);

}  // namespace REALCAM_NAMESPACE
