#pragma once
#include "../../platform.hpp"
#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Irradiance in the middle of the film for unit radiance: the area, in direction cosines, that passes the lens there,
/// pi sin^2(theta') less what is blocked in the middle. By real rays in the meridional plane; the iris counts as round.
double axis_irradiance(LensSystem lens);

}  // namespace REALCAM_NAMESPACE
