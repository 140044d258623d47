#pragma once
#include <cmath>

#include "../materials/light_sample.hpp"
#include "../scene_view.hpp"

namespace REALCAM_NAMESPACE {

// Attenuation of light by the air (AirView) and by the interior of glass.

/// Returns the transmittance of a medium over a distance in metres (Beer-Lambert). `extinction`: per metre.
REALCAM_INLINE Color transmittance(Color extinction, float distance) {
    return {std::exp(-distance * extinction.r), std::exp(-distance * extinction.g), std::exp(-distance * extinction.b)};
}

/// Part of a ray that lies in the air.
struct AirInterval {
    float begin, length;  ///< distance from the ray's origin, and length, m; a length of 0: the ray misses the air
};

/// Returns the part in the air of a ray with this length, m. `direction`: unit vector.
REALCAM_INLINE AirInterval air_interval(const AirView& air, Vec3f origin, Vec3f direction, float distance) {
    float begin = 0.0f, end = distance;
    const auto clip = [&](float low, float high, float from, float along) {
        const float inverse = 1.0f / along, a = (low - from) * inverse, b = (high - from) * inverse;
        const float enter = select(a < b, a, b), leave = select(a < b, b, a);
        begin = select(enter > begin, enter, begin);
        end = select(leave < end, leave, end);
    };
    clip(air.low.x, air.high.x, origin.x, direction.x);
    clip(air.low.y, air.high.y, origin.y, direction.y);
    clip(air.low.z, air.high.z, origin.z, direction.z);
    return begin < end ? AirInterval{begin, end - begin} : AirInterval{0.0f, 0.0f};
}

/// Returns the transmittance of the air between a position and a light that was sampled there.
REALCAM_INLINE Color transmittance_to_light(const AirView& air, Vec3f position, const LightSample& light) {
    return transmittance(air.extinction, air_interval(air, position, light.direction, light.distance).length);
}

/// Attenuates a light sample by the air between a position and the light. Only scenes of SceneKind::any have air.
template <SceneKind scene_kind>
REALCAM_INLINE void attenuate(const AirView& air, Vec3f position, LightSample& light) {
    if constexpr (scene_kind == SceneKind::any)
        if (air.is_present()) light.irradiance *= transmittance_to_light(air, position, light);
}

}  // namespace REALCAM_NAMESPACE
