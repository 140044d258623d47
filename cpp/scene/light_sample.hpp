#pragma once
#include "scene_view.hpp"

namespace REALCAM_NAMESPACE {

inline constexpr float kFarAway = 3.0e38f;

/// One light direction at a point: divided by the density, but without the reflectance and the cosine at the point.
struct LightSample {
    Vec3f direction;   ///< unit, towards the light
    float distance;    ///< to the light; kFarAway for sun and environment
    float reach;       ///< share of the distance at which a shadow ray ends, so as not to meet the light itself
    Vec3f irradiance;  ///< arriving at a right angle, over the density; 0: nothing arrives
};

}  // namespace REALCAM_NAMESPACE
