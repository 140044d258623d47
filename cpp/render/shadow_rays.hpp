#pragma once
#include "../scene/light.hpp"
#include "../scene/surface_point.hpp"
#include "path_state.hpp"

namespace REALCAM_NAMESPACE {

/// Start of a ray, offset to the side of its direction, so that it does not hit its own surface again.
REALCAM_INLINE Vec3f ray_start(const RaySpawnPoint& spawn, Vec3f direction) {
    const float offset = select(dot(spawn.geometric_normal, direction) < 0.0f, -spawn.self_offset, spawn.self_offset);
    return spawn.position + offset * spawn.geometric_normal;
}

/// Rays that test the visibility of lights.
template <int N>
struct ShadowRays {
    SceneRays<N> rays;
    ColorLanes<N> unshadowed;  ///< contribution to the film if nothing occludes the light

    /// `seen`: contribution to the film if nothing occludes the light. Without branches, so that it is vectorised.
    REALCAM_INLINE void set(int lane, const RaySpawnPoint& spawn, const LightSample& light, Color seen) {
        const Vec3f start = ray_start(spawn, light.direction);
        // For a near light the ray's direction is the vector from its start to the light, so that the distance is 1:
        // the light may be as near as the offset. The ray stops short of the light, which is itself in the scene.
        const bool is_near = light.distance < kFarAway;
        const Vec3f offset = light.distance * light.direction - (start - spawn.position);
        rays.origin.set(lane, start);
        rays.direction.set(lane, select(is_near, offset, light.direction));
        rays.far[lane] = select(is_near, select(light.reach > 0.0f, light.reach, 0.0f), kFarAway);
        rays.active[lane] = is_black(seen) ? 0 : 1;
        unshadowed.set(lane, seen);
    }
};

/// Shadow rays of many paths, to be traced together: one for each light sample.
template <int N>
struct LightRays {
    ShadowRays<N> rays[kLightSampleCount];

    REALCAM_INLINE ShadowRays<N>& operator[](int number) { return rays[number]; }
    REALCAM_INLINE void trace(int, bool) {}
};

}  // namespace REALCAM_NAMESPACE
