#pragma once
#include "../../platform.hpp"
#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Irradiance at the film's centre for unit radiance: the area that passes the lens in direction cosines, pi
/// sin^2(theta') less a central obstruction. Computed with real meridional rays; the iris is treated as round. Throws
/// InputError unless the lens is a centred lens of revolution.
double axis_irradiance(LensSystem lens);

}  // namespace REALCAM_NAMESPACE
