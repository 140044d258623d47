#pragma once
#include <cstdint>

#include "../../math/color.hpp"

namespace REALCAM_NAMESPACE {

// Input and result of light sampling at a surface point (lights/light.hpp).

inline constexpr float kFarAway = 3.0e38f;  ///< distance of lights at infinity

/// Rough microfacet lobe at a receiver, for choosing lights by their reflection in it.
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
    LightLobe lobe = {};  ///< a share of 0: a purely Lambertian receiver
};

/// Sampling strategy for the environment at a surface that other lights illuminate as well. Choosing one light at
/// random is noisiest if the strongest light is occluded.
enum class SkySampling : std::int32_t {
    chosen,  ///< the environment is one of the lights among which the light sample is chosen
    apart,  ///< it has a light sample of its own if it contributes at least kSeparateFraction of the light
    bsdf_only  ///< no light samples; BSDF samples, whose density would be the same, reach it
};

/// Sampled direction of incident light, before the visibility test.
struct LightSample {
    Vec3f direction;  ///< unit, towards the light
    float distance;   ///< to the light, m; kFarAway for sun and environment
    float reach;  ///< fraction of the distance at which a shadow ray ends, so that it does not hit the light itself
    Color irradiance;  ///< at perpendicular incidence, divided by the density, lux; black: no light
    float pdf;  ///< density per steradian; kDelta for point lights and suns, which BSDF samples cannot hit
};

}  // namespace REALCAM_NAMESPACE
