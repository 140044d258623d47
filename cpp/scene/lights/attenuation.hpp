#pragma once
#include <cmath>

#include "../materials/light_sample.hpp"
#include "../scene_view.hpp"

namespace REALCAM_NAMESPACE {

// Attenuation of light by media: the air (AirView) and the interiors of glass.

/// Returns the transmittance of a medium over a distance in metres (Beer-Lambert). `extinction`: per metre.
REALCAM_INLINE Color transmittance(Color extinction, float distance) {
    return {std::exp(-distance * extinction.r), std::exp(-distance * extinction.g), std::exp(-distance * extinction.b)};
}

/// Part of a ray that lies in a medium.
struct MediumInterval {
    float begin, length;  ///< distance from the ray's origin, and length, m; a length of 0: the ray misses the medium
};

/// Returns the part in the air of a ray with this length, m. `direction`: unit vector.
REALCAM_INLINE MediumInterval air_interval(const AirView& air, Vec3f origin, Vec3f direction, float distance) {
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
    return begin < end ? MediumInterval{begin, end - begin} : MediumInterval{0.0f, 0.0f};
}

// `interior`: the material of the glass around a ray, whose interior the ray crosses; null: the ray is outside of
// glass.

/// Returns the medium that a ray crosses.
REALCAM_INLINE Medium medium_around(const AirView& air, const Material* interior) {
    if (interior) return interior->interior();
    return air;
}

/// Returns the part of a ray, of this length in metres, in the medium that it crosses. `direction`: unit vector.
REALCAM_INLINE MediumInterval medium_interval(const AirView& air, const Material* interior, Vec3f origin,
                                              Vec3f direction, float distance) {
    return interior ? MediumInterval{0.0f, distance} : air_interval(air, origin, direction, distance);
}

/// Returns the transmittance of the medium between a position and a light that was sampled there.
REALCAM_INLINE Color transmittance_to_light(const AirView& air, const Material* interior, Vec3f position,
                                            const LightSample& light) {
    return transmittance(medium_around(air, interior).extinction,
                         medium_interval(air, interior, position, light.direction, light.distance).length);
}

/// Attenuates a light sample by the air between a position and the light. Only scenes of SceneKind::any have air.
template <SceneKind scene_kind>
REALCAM_INLINE void attenuate(const AirView& air, Vec3f position, LightSample& light) {
    if constexpr (scene_kind == SceneKind::any)
        if (air.is_present()) light.irradiance *= transmittance_to_light(air, nullptr, position, light);
}

}  // namespace REALCAM_NAMESPACE
