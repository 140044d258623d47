#pragma once
#include <cstdint>

#include "../math/color.hpp"

namespace REALCAM_NAMESPACE {

inline constexpr float kFarAway = 3.0e38f;

/// A lobe of rough facets, by which lights are chosen that it shows.
struct LightLobe {
    Vec3f to_eye = {0, 0, 0};  ///< unit
    float alpha = 1;           ///< of the facets (ggx.hpp)
    float share = 0;           ///< of what the surface scatters, about; the rest is Lambert's
};

REALCAM_INLINE LightLobe select(bool condition, const LightLobe& a, const LightLobe& b) {
    return {select(condition, a.to_eye, b.to_eye), select(condition, a.alpha, b.alpha),
            select(condition, a.share, b.share)};
}

/// Where and when light is wanted.
struct LightReceiver {
    Vec3f position;
    Vec3f normal;  ///< of the surface, on the side that light can reach; zero: light may come from all sides
    float time = 0;  ///< share of the exposure; for SceneKind::any alone
    LightLobe lobe = {};
};

/// How the environment is looked for at a surface beside other lights. A choice between the two is noisiest where the
/// stronger one is hidden.
enum class SkySampling : std::int32_t {
    chosen,       ///< as one of the lights
    apart,        ///< by a sample of its own, where it brings a good part of the light
    left_to_rays  ///< by the scattered ray alone, whose directions have the density that samples would have
};

/// A direction from which light may come to a receiver.
struct LightSample {
    Vec3f direction;  ///< unit, towards the light
    float distance;   ///< to the light; kFarAway for sun and environment
    float reach;      ///< share of the distance at which a shadow ray ends, so as not to meet the light itself
    Color irradiance; ///< arriving at a right angle, over the density; black: nothing arrives
    float pdf;        ///< of the direction, per steradian; kDelta for points and suns, which no scattered ray meets
};

}  // namespace REALCAM_NAMESPACE
