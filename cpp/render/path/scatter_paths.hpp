#pragma once
#include "../../scene/geometry/surface_point.hpp"
#include "../../scene/lights/light.hpp"
#include "../../scene/materials/glossy_bsdf.hpp"
#include "path_state.hpp"
#include "shade_hits.hpp"

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

/// Restricts a BSDF to the lobes that send out a ray, if not all do.
template <class BsdfT>
REALCAM_INLINE void keep_senders(const PathSettings& settings, BsdfT& bsdf) {
    if (settings.transport == LightTransport::whitted)
        bsdf.keep_mirrors();
    else
        bsdf.keep_narrow_lobes();
}

/// Sets the shadow ray and the unoccluded contribution of a light sample, for a path at a surface.
template <int N, class BsdfT>
REALCAM_INLINE void light_path(const PathSettings& settings, int bounce, int lane, const RaySpawnPoint& spawn,
                               BsdfT bsdf, const LightSample& light, const PathState<N>& path, ShadowRays<N>& shadow) {
    const Color all_lobes = bsdf.eval(light.direction);
    Color seen;
    if (goes_on(settings, bounce)) {
        seen = mis_weight(light.pdf, bsdf.pdf(light.direction)) * all_lobes;
    } else {
        // Lobes that send out no ray get light from light samples alone, with a weight of 1.
        keep_senders(settings, bsdf);
        const Color of_senders = bsdf.eval(light.direction);
        seen = all_lobes;
        if (!is_black(of_senders)) seen += (mis_weight(light.pdf, bsdf.pdf(light.direction)) - 1.0f) * of_senders;
    }
    seen *= path.throughput[lane] * light.irradiance;
    const float limit = bounce > 0 ? settings.clamp * path.weight[lane] : 0.0f;
    shadow.set(lane, spawn, light, clamped(seen, limit));
}

/// Samples the next ray of a path at a surface. `u`, `chance`: random numbers for it. Returns true if the ray is
/// refracted through the surface.
template <int N, class BsdfT>
REALCAM_INLINE bool scatter_path(const PathSettings& settings, int bounce, int lane, const RaySpawnPoint& spawn,
                                 const LightReceiver& receiver, BsdfT& bsdf, const PathNumbers<N>& u, float chance,
                                 PathState<N>& path) {
    if (!goes_on(settings, bounce)) keep_senders(settings, bsdf);
    const BsdfSample next = bsdf.sample(u[lane], chance);
    const Color throughput = path.throughput[lane] * next.weight;
    path.throughput.set(lane, throughput);
    path.rays.origin.set(lane, ray_start(spawn, next.direction));
    path.rays.direction.set(lane, next.direction);
    path.rays.active[lane] = !is_black(throughput);
    path.pdf[lane] = next.pdf;
    path.receiver_position.set(lane, receiver.position);
    path.receiver_normal.set(lane, receiver.normal);
    return next.refracted;
}

namespace scatter_paths_detail {

/// Samples a light in proportion to its unoccluded illuminance: one of eight pairs of samples, chosen by its share of
/// their illuminance (resampling, Talbot et al. 2005). If all of those are behind the surface, up to 64 are drawn.
/// Black if there is no light.
template <SceneKind scene_kind>
REALCAM_ONE_COPY LightSample light_by_illuminance(const SceneView& scene, LightReceiver receiver, std::uint32_t seed) {
    LightSample chosen{{0, 1, 0}, kFarAway, 1.0f, {0, 0, 0}, kDelta};
    float sum = 0.0f;
    for (int i = 0; i < 8 || (i < 64 && !(sum > 0.0f)); ++i) {
        const auto random = [&] { return unit_float(seed = hash32(seed)); };
        REALCAM_NO_UNROLL
        for (int k = 0; k < kLightSampleCount; ++k) {
            if (!has_light(scene, SkySampling::apart, k)) continue;
            const Vec2f u = {random(), random()};
            const LightSample light = sample_light<scene_kind>(scene, SkySampling::apart, receiver, k, u, hash32(seed));
            const float cosine = dot(receiver.normal, light.direction);
            const float illuminance = cosine > 0.0f ? cosine * luminance(light.irradiance) : 0.0f;
            sum += illuminance;
            if (random() * sum < illuminance) chosen = light;
        }
    }
    return chosen;
}

}  // namespace scatter_paths_detail

/// Scatters a path at a point. `seed`: of the sample at this bounce. `shadow`: a LightRays, or a type with the same
/// interface that traces each ray once it is set. Returns true if the surface shows only shadows.
template <SceneKind scene_kind, int N, class LightRaysT>
REALCAM_INLINE bool scatter_at(const SceneView& view, const PathSettings& settings, int bounce, int slot,
                               const SurfacePoint& point, const PathNumbers<N>& light_numbers,
                               const PathNumbers<N>& scatter_numbers, std::uint32_t seed, PathState<N>& path,
                               LightRaysT& shadow) {
    using namespace scatter_paths_detail;
    const Vec3f direction = path.rays.direction[slot];
    const float time = time_of<scene_kind>(path, slot);
    if constexpr (scene_kind == SceneKind::any) {
        if (point.material->only_shadows) {
            // The background is visible to the extent that the light here is not occluded. The ray keeps its direction,
            // and therefore its density.
            const LightSample light =
                light_by_illuminance<scene_kind>(view, {point.position, point.normal, time}, seed);
            path.rays.origin.set(slot, ray_start(point, direction));
            path.rays.active[slot] = 1;
            shadow[0].set(slot, point, light, {0, 0, 0});
            shadow[0].rays.active[slot] = !is_black(light.irradiance);
            shadow.trace(0, true);
            return true;
        }
    }
    auto bsdf = make_bsdf<scene_kind>(point, -direction);
    LightReceiver receiver = {point.position, bsdf.is_opaque() ? point.normal : Vec3f{0, 0, 0}, time};
    if constexpr (scene_kind != SceneKind::plain) receiver.lobe = light_lobe(point, -direction);
    const SkySampling sky = sky_sampling(view, goes_on(settings, bounce), bounce == 0);
    // Unrolled code would overflow the instruction cache of a GPU.
    REALCAM_NO_UNROLL
    for (int k = 0; k < kLightSampleCount; ++k) {
        if (!has_light(view, sky, k)) continue;
        const LightSample light = sample_light<scene_kind>(view, sky, receiver, k, light_numbers[slot], seed);
        light_path(settings, bounce, slot, point, bsdf, light, path, shadow[k]);
        shadow.trace(k, false);
    }
    const bool refracted =
        scatter_path(settings, bounce, slot, point, receiver, bsdf, scatter_numbers, unit_float(seed), path);
    if constexpr (scene_kind == SceneKind::any) path.receiver_sky[slot] = sky;
    if constexpr (scene_kind != SceneKind::plain) {
        path.set_receiver_lobe(slot, receiver.lobe);
        if (refracted) path.absorption.set(slot, point.is_front ? point.material->absorption : Color{0, 0, 0});
    }
    return false;
}

}  // namespace REALCAM_NAMESPACE
