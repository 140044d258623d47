#pragma once
#include "../camera/camera.hpp"
#include "../scene/scene.hpp"

namespace REALCAM_NAMESPACE {

/// Adds daylight to a scene without light: a slightly warm sun of 80 klux at the upper left behind the camera, 46
/// degrees above its horizon, and a slightly blue sky of 5000 cd/m^2 all around. Together about 95 klux, for which the
/// sunny-16 rule holds.
void add_daylight(Scene& scene, const Pose& pose);

}  // namespace REALCAM_NAMESPACE
