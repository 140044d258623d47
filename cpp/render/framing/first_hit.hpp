#pragma once
#include "../../scene/assembly.hpp"

namespace REALCAM_NAMESPACE {

/// Returns the distance in metres from `origin` along the unit vector `direction` to the first triangle that is farther
/// than `beyond_m`; infinite if there is none. Tests every triangle, which costs less than building a hierarchy for the
/// few rays that placing a camera takes.
double first_hit(const Assembly& assembly, Vec3d origin, Vec3d direction, double beyond_m = 0);

}  // namespace REALCAM_NAMESPACE
