#pragma once
#include "meet_surfaces.hpp"
#include "path_numbers.hpp"

namespace REALCAM_NAMESPACE {

// sample_light for all lanes of a block at once, in scenes that are plain: what area lights and a constant environment
// ask for is vector code.

template <int N>
struct LightSamples {
    Vec3Lanes<float, N> direction;
    ColorLanes<N> irradiance;
    alignas(kLaneAlignment<float, N>) float distance[N], reach[N], pdf[N];

    REALCAM_INLINE LightSample operator[](int lane) const {
        return {direction[lane], distance[lane], reach[lane], irradiance[lane], pdf[lane]};
    }
    REALCAM_INLINE void set(int lane, const LightSample& sample) {
        direction.set(lane, sample.direction);
        irradiance.set(lane, sample.irradiance);
        distance[lane] = sample.distance;
        reach[lane] = sample.reach;
        pdf[lane] = sample.pdf;
    }
};

namespace plain_light_samples_detail {

enum class Source : std::int32_t { none, area, sky, other };

/// The lights that lanes have picked.
template <int N>
struct PickedLights {
    alignas(kLaneAlignment<std::int32_t, N>) Source source[N];
    alignas(kLaneAlignment<float, N>) float probability[N];
    Vec2Lanes<float, N> u;  ///< what the choice has left of the random numbers
    LightSamples<N> others;
    // Of area lights:
    Vec3Lanes<float, N> corner, edge_u, edge_v, normal;
    ColorLanes<N> radiance;
    alignas(kLaneAlignment<float, N>) float area[N], margin[N];
    bool any_area = false, any_sky = false, any_other = false;

    REALCAM_INLINE void set_area(int lane, const AreaLight& light) {
        source[lane] = Source::area;
        any_area = true;
        corner.set(lane, light.corner);
        edge_u.set(lane, light.edge_u);
        edge_v.set(lane, light.edge_v);
        normal.set(lane, light.normal);
        radiance.set(lane, light.radiance);
        area[lane] = light.area;
        margin[lane] = light.margin;
    }
    REALCAM_INLINE void set_sky(int lane) {
        source[lane] = Source::sky;
        any_sky = true;
    }
    REALCAM_INLINE void set_other(int lane, const LightSample& sample) {
        source[lane] = Source::other;
        any_other = true;
        others.set(lane, sample);
    }
    REALCAM_INLINE AreaLight area_light(int lane) const {
        return {
            corner[lane], edge_u[lane], edge_v[lane], normal[lane], 0, radiance[lane], area[lane], margin[lane], 0, 0};
    }
};

/// light_kinds of all surfaces.
template <int N>
class LightKindsLanes {
public:
    REALCAM_INLINE LightKindsLanes(const SceneView& scene, const PlainSurfaces<N>& surfaces) {
        alignas(kLaneAlignment<float, N>) float local[N] = {}, suns[N] = {};
        if (count_light_kinds(scene) > 1) {
            if (scene.light_node_count > 0) {
                const LightNode all = scene.light_nodes[0];
                REALCAM_LANES
                for (int i = 0; i < N; ++i)
                    local[i] = light_importance(all, {surfaces.position[i], surfaces.normal[i]});
            }
            for (int k = 0; k < scene.sun_count; ++k) {
                const SunLight sun = scene.suns[k];
                REALCAM_LANES
                for (int i = 0; i < N; ++i) suns[i] += sun_importance(sun, surfaces.normal[i]);
            }
        }
        REALCAM_LANES
        for (int i = 0; i < N; ++i) {
            const LightKinds kinds = light_kinds(scene, local[i], suns[i]);
            even_[i] = kinds.shares.even;
            scale_[i] = kinds.shares.scale;
            local_[i] = kinds.local_probability;
            environment_[i] = kinds.environment_probability;
        }
    }
    REALCAM_INLINE LightKinds operator[](int lane) const {
        return {{even_[lane], scale_[lane]}, local_[lane], environment_[lane]};
    }

private:
    alignas(kLaneAlignment<float, N>) float even_[N], scale_[N], local_[N], environment_[N];
};

/// As pick_light does for one receiver.
template <int N, class Seeds>
REALCAM_INLINE void pick_lights(const SceneView& scene, const PlainSurfaces<N>& surfaces, const PathNumbers<N>& u,
                                const Seeds& seed, PickedLights<N>& picked) {
    const LightKindsLanes<N> kinds(scene, surfaces);
    for (int i = 0; i < N; ++i) {
        picked.source[i] = Source::none;
        if (!surfaces.scatters[i]) continue;
        const LightReceiver receiver = {surfaces.position[i], surfaces.normal[i]};
        const LightPick pick = pick_light(scene, receiver, kinds[i], u[i], seed(i));
        if (!(pick.probability > 0.0f)) continue;
        picked.u.set(i, pick.u);
        picked.probability[i] = pick.probability;
        if (pick.kind == LightKind::area)
            picked.set_area(i, scene.areas[pick.index]);
        else if (pick.kind == LightKind::environment && !scene.environment.pixels)
            picked.set_sky(i);
        else
            picked.set_other(i, sample_picked<SceneKind::plain>(scene, receiver, pick));
    }
}

}  // namespace plain_light_samples_detail

/// A sample for each surface on which a path scatters; elsewhere black. `u` and `seed(lane)`: as sample_light's.
template <int N, class Seeds>
REALCAM_INLINE void sample_lights(const SceneView& scene, const PlainSurfaces<N>& surfaces, const PathNumbers<N>& u,
                                  const Seeds& seed, LightSamples<N>& samples) {
    using namespace plain_light_samples_detail;
    PickedLights<N> picked;
    pick_lights(scene, surfaces, u, seed, picked);
    if (picked.any_area) {
        REALCAM_LANES
        for (int i = 0; i < N; ++i) {
            const WayToLight way =
                way_to(picked.area_light(i), false, surfaces.position[i], sample_triangle(picked.u[i]));
            const float scale = 1.0f / way.pdf;
            samples.direction.set(i, way.direction);
            samples.irradiance.set(i, select(way.cosine > 0.0f, scale, 0.0f) * picked.radiance[i]);
            samples.distance[i] = way.distance;
            samples.reach[i] = way.reach;
            samples.pdf[i] = way.pdf;
        }
    }
    if (picked.any_sky) {
        const Color radiance = scene.environment.constant;
        REALCAM_LANES
        for (int i = 0; i < N; ++i) {
            const bool is_sky = picked.source[i] == Source::sky;
            const Vec3f direction = sample_cosine(surfaces.normal[i], picked.u[i]);
            const float pdf = cosine_pdf(surfaces.normal[i], direction);
            samples.direction.set(i, select(is_sky, direction, samples.direction[i]));
            samples.irradiance.set(
                i, select(is_sky, select(pdf > 0.0f, 1.0f / pdf, 0.0f) * radiance, samples.irradiance[i]));
            samples.distance[i] = select(is_sky, kFarAway, samples.distance[i]);
            samples.reach[i] = select(is_sky, 1.0f, samples.reach[i]);
            samples.pdf[i] = select(is_sky, pdf, samples.pdf[i]);
        }
    }
    if (picked.any_other) {
        for (int i = 0; i < N; ++i)
            if (picked.source[i] == Source::other) samples.set(i, picked.others[i]);
    }
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        const float probability = picked.probability[i];
        const bool is_lit = (picked.source[i] != Source::none) & (probability > 0.0f);
        samples.irradiance.set(
            i, select(is_lit, bounded_light((1.0f / probability) * samples.irradiance[i]), Color{0, 0, 0}));
        samples.pdf[i] = probability * samples.pdf[i];
    }
}

}  // namespace REALCAM_NAMESPACE
