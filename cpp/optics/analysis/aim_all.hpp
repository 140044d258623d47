#pragma once
#include <vector>

#include "../pupil/pupil_pattern.hpp"
#include "../trace/ray_loop.hpp"
#include "aim_request.hpp"
#include "ray_aiming.hpp"

namespace REALCAM_NAMESPACE {

/// Returns the rays through all points of a pattern on the stop, in units of `reach`. Large patterns are aimed
/// together, starting from a fitted map from stop to entry plane, and as accurately as one by one; rays for which this
/// fails are aimed one by one. Passes on what `loop` throws to stop it.
std::vector<AimedRay> aim_all(const RayAimer& aim, const std::vector<PupilPoint>& pattern, double reach,
                              const RayLoop& loop = {});

}  // namespace REALCAM_NAMESPACE
