#pragma once
#include <cstdint>

#include "../../math/color.hpp"

namespace REALCAM_NAMESPACE {

inline constexpr float kFarAway = 3.0e38f;

/// Rough microfacet lobe, by which lights are chosen.
struct LightLobe {
    Vec3f to_eye = {0, 0, 0};  ///< unit
    float alpha = 1;  ///< GGX alpha (ggx_albedo.hpp)
    float share = 0;  ///< approximate share of the scattered light; the Lambertian lobe has the complement
};

REALCAM_INLINE LightLobe select(bool condition, const LightLobe& a, const LightLobe& b) {
    return {select(condition, a.to_eye, b.to_eye), select(condition, a.alpha, b.alpha),
            select(condition, a.share, b.share)};
}

/// Point and time at which incident light is estimated.
struct LightReceiver {
    Vec3f position;
    Vec3f normal;  ///< surface normal on the side that light can reach; zero: light may come from all directions
    float time = 0;  ///< fraction of the exposure; used only for SceneKind::any
    LightLobe lobe = {};
};

/// How the environment is sampled at a surface beside other lights. A choice between the two is noisiest if the
/// stronger one is occluded.
enum class SkySampling : std::int32_t {
    chosen,  ///< chosen among the lights
    apart,  ///< by a sample of its own if it contributes a good part of the light
    left_to_rays  ///< only by BSDF sampling, whose density equals that of light samples
};

/// Sampled direction of incident light, before the visibility test.
struct LightSample {
    Vec3f direction;  ///< unit, towards the light
    float distance;   ///< to the light; kFarAway for sun and environment
    float reach;  ///< fraction of the distance at which a shadow ray ends, so that it does not hit the light itself
    Color irradiance;  ///< at perpendicular incidence, divided by the density; black: no light
    float pdf;  ///< of the direction, per steradian; kDelta for point lights and suns, which BSDF samples cannot hit
};

}  // namespace REALCAM_NAMESPACE
