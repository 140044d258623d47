#pragma once
#include "../../scene/geometry/surface_point.hpp"
#include "../../scene/lights/light.hpp"
#include "../../scene/materials/glossy_bsdf.hpp"
#include "../../scene/materials/phase_function.hpp"
#include "path_state.hpp"
#include "shade_hits.hpp"

// Next-event estimation (direct light sampling) and BSDF sampling of one path at one surface.

namespace REALCAM_NAMESPACE {

/// Returns the start of a ray that leaves a surface: the point is offset along the normal, to the side of the ray's
/// direction, so that the ray does not hit its own surface again.
REALCAM_INLINE Vec3f ray_start(const RaySpawnPoint& spawn, Vec3f direction) {
    const float offset = select(dot(spawn.geometric_normal, direction) < 0.0f, -spawn.self_offset, spawn.self_offset);
    return spawn.position + offset * spawn.geometric_normal;
}

/// Attenuates a light sample at a surface by the medium between surface and light. `behind`: the material whose
/// interior a path enters if it passes the surface; null: the path leaves glass, or cannot pass.
template <SceneKind scene_kind, int N>
REALCAM_INLINE void attenuate_light(const SceneView& view, const RaySpawnPoint& spawn, const Material* behind,
                                    const PathState<N>& path, int slot, LightSample& light) {
    if constexpr (scene_kind == SceneKind::any) {
        if (!view.has_scattering_media) return;
        const Material* interior = dot(spawn.geometric_normal, light.direction) < 0.0f ? behind : path.interior[slot];
        if (interior || view.air.is_present())
            light.irradiance *= transmittance_to_light(view.air, interior, spawn.position, light);
    }
}

/// Shadow rays with the contributions that they test.
template <int N>
struct ShadowRays {
    SceneRays<N> rays;
    ColorLanes<N> unoccluded;  ///< irradiance on the film if nothing occludes the light

    /// Sets the shadow ray of a slot from a surface to a light; inactive if `contribution`, the irradiance on the film
    /// if nothing occludes the light, is black. Without branches, so that loops over slots are vectorised.
    REALCAM_INLINE void set(int slot, const RaySpawnPoint& spawn, const LightSample& light, Color contribution) {
        const Vec3f start = ray_start(spawn, light.direction);
        // For a light at a finite distance, the ray's direction is the vector from its start to the light and the ray
        // ends at LightSample::reach < 1, short of the light's own geometry. Normalising instead would fail for a light
        // that is as near as the offset of the start.
        const bool is_finite = light.distance < kFarAway;
        const Vec3f offset = light.distance * light.direction - (start - spawn.position);
        rays.origin.set(slot, start);
        rays.direction.set(slot, select(is_finite, offset, light.direction));
        rays.far[slot] = select(is_finite, select(light.reach > 0.0f, light.reach, 0.0f), kFarAway);
        rays.active[slot] = is_black(contribution) ? 0 : 1;
        unoccluded.set(slot, contribution);
    }
};

/// Shadow rays of many paths, one ShadowRays for each light sample. The caller traces all of them once they are set, so
/// that trace() does nothing here; for a GPU it traces the ray at once (scatter_one in advance_path.hpp).
template <int N>
struct LightRays {
    ShadowRays<N> rays[kLightSampleCount];

    REALCAM_INLINE ShadowRays<N>& operator[](int number) { return rays[number]; }
    REALCAM_INLINE void trace(int, bool) {}
};

/// Removes from a BSDF the lobes that are not sampled for the next ray if all_lobes_scatter is false: with
/// LightTransport::whitted all but mirrors, else (after the last bounce) the Lambertian lobe.
template <class BsdfT>
REALCAM_INLINE void keep_scattering_lobes(const PathSettings& settings, BsdfT& bsdf) {
    if (settings.transport == LightTransport::whitted)
        bsdf.keep_delta_lobes();
    else
        bsdf.remove_diffuse_lobe();
}

/// Sets the shadow ray of a slot and its unoccluded contribution: the light sample, reflected by the BSDF, with its MIS
/// weight against BSDF sampling.
template <int N, class BsdfT>
REALCAM_INLINE void set_direct_light(const PathSettings& settings, int bounce, int slot, const RaySpawnPoint& spawn,
                                     BsdfT bsdf, const LightSample& light, const PathState<N>& path,
                                     ShadowRays<N>& shadow) {
    const Color all_lobes = bsdf.eval(light.direction);
    Color contribution;
    if (all_lobes_scatter(settings, bounce)) {
        contribution = mis_weight(light.pdf, bsdf.pdf(light.direction)) * all_lobes;
    } else {
        // Lobes that are not sampled receive light from light samples alone, with a weight of 1.
        keep_scattering_lobes(settings, bsdf);
        const Color from_scattering = bsdf.eval(light.direction);
        contribution = all_lobes;
        if (!is_black(from_scattering))
            contribution += (mis_weight(light.pdf, bsdf.pdf(light.direction)) - 1.0f) * from_scattering;
    }
    contribution *= path.throughput[slot] * light.irradiance;
    const float limit = bounce > 0 ? settings.clamp * path.weight[slot] : 0.0f;
    shadow.set(slot, spawn, light, clamped(contribution, limit));
}

/// Samples the next ray of the path in a slot from the BSDF, and ends the path if its throughput becomes black. `u`:
/// the pair of random numbers of each slot for the direction; `chance`: random number in [0, 1) that chooses the lobe.
/// `receiver`: the surface, as stored for the MIS weight of the emitter that the ray may hit. Returns true if the ray
/// is refracted through the surface.
template <int N, class BsdfT>
REALCAM_INLINE bool scatter_path(const PathSettings& settings, int bounce, int slot, const RaySpawnPoint& spawn,
                                 const LightReceiver& receiver, BsdfT& bsdf, const PathNumbers<N>& u, float chance,
                                 PathState<N>& path) {
    if (!all_lobes_scatter(settings, bounce)) keep_scattering_lobes(settings, bsdf);
    const BsdfSample next = bsdf.sample(u[slot], chance);
    const Color throughput = path.throughput[slot] * next.weight;
    path.throughput.set(slot, throughput);
    path.rays.origin.set(slot, ray_start(spawn, next.direction));
    path.rays.direction.set(slot, next.direction);
    path.rays.active[slot] = !is_black(throughput);
    path.pdf[slot] = next.pdf;
    path.receiver_position.set(slot, receiver.position);
    path.receiver_normal.set(slot, receiver.normal);
    return next.refracted;
}

namespace scatter_paths_detail {

/// Number of candidates among which light_by_illuminance chooses, and the limit if all of them are behind the surface.
inline constexpr int kLightCandidates = 8, kMaxLightCandidates = 64;

/// Samples a light approximately in proportion to its unoccluded illuminance, by resampled importance sampling (Talbot
/// et al. 2005): draws candidates, and chooses one with a probability proportional to its illuminance. Returns a black
/// sample if no candidate illuminates the receiver. `seed`: random bits.
template <SceneKind scene_kind>
REALCAM_ONE_COPY LightSample light_by_illuminance(const SceneView& scene, LightReceiver receiver, std::uint32_t seed) {
    LightSample chosen{{0, 1, 0}, kFarAway, 1.0f, {0, 0, 0}, kDelta};
    float sum = 0.0f;
    for (int i = 0; i < kLightCandidates || (i < kMaxLightCandidates && !(sum > 0.0f)); ++i) {
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

/// Continues a path at a point at which a medium scatters it. `anisotropy`: of the medium. The density in the path's
/// state is the factor by which cross_medium has multiplied that of the phase function.
template <int N>
REALCAM_INLINE void scatter_in_medium(float anisotropy, int slot, Vec3f position, Vec2f u, PathState<N>& path) {
    const Vec3f arriving = path.rays.direction[slot], direction = sample_henyey_greenstein(anisotropy, arriving, u);
    path.rays.origin.set(slot, position);
    path.rays.direction.set(slot, direction);
    path.rays.active[slot] = !is_black(path.throughput[slot]);
    path.pdf[slot] *= henyey_greenstein(anisotropy, dot(arriving, direction));
    path.receiver_position.set(slot, position);
    path.receiver_normal.set(slot, {0, 0, 0});
    path.receiver_sky[slot] = SkySampling::chosen;
    path.set_receiver_lobe(slot, {});
}

}  // namespace scatter_paths_detail

/// Continues the path in a slot at a surface point: sets the shadow rays of its light samples, and samples its next
/// ray. `light_numbers`, `scatter_numbers`: random numbers for the two; `seed`: random bits of the sample at this
/// bounce. `shadow`: a LightRays, or a type with the same interface whose trace() traces the ray that was set last.
/// Returns true if the surface is a shadow catcher (Material::only_shadows): the ray then continues in its direction,
/// and the path ends if the shadow ray is occluded.
template <SceneKind scene_kind, int N, class LightRaysT>
REALCAM_INLINE bool scatter_at(const SceneView& view, const PathSettings& settings, int bounce, int slot,
                               const SurfacePoint& point, const PathNumbers<N>& light_numbers,
                               const PathNumbers<N>& scatter_numbers, std::uint32_t seed, PathState<N>& path,
                               LightRaysT& shadow) {
    using namespace scatter_paths_detail;
    const Vec3f direction = path.rays.direction[slot];
    const float time = time_of<scene_kind>(path, slot);
    if constexpr (scene_kind == SceneKind::any) {
        if (!point.material) {
            const float anisotropy = medium_around(view.air, path.interior[slot]).anisotropy;
            scatter_in_medium(anisotropy, slot, point.position, scatter_numbers[slot], path);
            return false;
        }
        if (point.material->only_shadows) {
            // The background is visible with the probability that the light here is not occluded. The ray keeps its
            // direction, and therefore its stored density and receiver.
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
    const SkySampling sky = sky_sampling(view, all_lobes_scatter(settings, bounce), bounce == 0);
    const Material* behind = point.is_front && !point.material->is_thin ? point.material : nullptr;
    // Unrolled code would overflow the instruction cache of a GPU.
    REALCAM_NO_UNROLL
    for (int k = 0; k < kLightSampleCount; ++k) {
        if (!has_light(view, sky, k)) continue;
        LightSample light = sample_light<scene_kind>(view, sky, receiver, k, light_numbers[slot], seed);
        attenuate_light<scene_kind>(view, point, behind, path, slot, light);
        set_direct_light(settings, bounce, slot, point, bsdf, light, path, shadow[k]);
        shadow.trace(k, false);
    }
    const bool refracted =
        scatter_path(settings, bounce, slot, point, receiver, bsdf, scatter_numbers, unit_float(seed), path);
    if constexpr (scene_kind == SceneKind::any) path.receiver_sky[slot] = sky;
    if constexpr (scene_kind != SceneKind::plain) {
        path.set_receiver_lobe(slot, receiver.lobe);
        if (refracted) path.interior[slot] = behind;
    }
    return false;
}

}  // namespace REALCAM_NAMESPACE
