#pragma once
#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// The lens with its film as one more surface: a mirror of that reflectance, as it is curved and placed, open up to
/// `radius` mm. For light that the film sends back into the lens.
LensSystem with_film_mirror(LensSystem lens, double reflectance, double radius);

}  // namespace REALCAM_NAMESPACE
