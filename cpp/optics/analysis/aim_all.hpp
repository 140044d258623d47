#pragma once
#include <vector>

#include "../pupil/pupil_pattern.hpp"
#include "../trace/ray_loop.hpp"
#include "aim_request.hpp"
#include "ray_aiming.hpp"

namespace REALCAM_NAMESPACE {

/// The rays through all places of a pattern, as shares of `reach`. Many are aimed together, from where a map of the
/// stop says that they cross the entry plane, and meet their places as nearly as if they were aimed one by one. Those
/// that the map does not lead to are. Throws what `loop` throws to stop it.
std::vector<AimedRay> aim_all(const RayAimer& aim, const std::vector<PupilPoint>& pattern, double reach,
                              const RayLoop& loop = {});

}  // namespace REALCAM_NAMESPACE
