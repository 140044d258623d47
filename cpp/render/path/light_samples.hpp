#pragma once
#include "../../scene/lights/environment.hpp"
#include "../../scene/scene_view.hpp"
#include "emitter_hit.hpp"
#include "light_choices.hpp"
#include "path_state.hpp"

namespace REALCAM_NAMESPACE {

// Light sampling for all paths of a block at once: the functions of scene/lights/light.hpp for many receivers,
// vectorised for area lights and the environment. The arithmetic is that of the functions for one receiver, which each
// comment names.

/// Samples pixels of the environment map for many pairs of random numbers, as sample_environment_image does for one.
/// operator[] returns the light sample of a slot.
template <int N>
class EnvironmentSamples {
public:
    REALCAM_INLINE EnvironmentSamples(const EnvironmentView& environment, const Vec2Lanes<float, N>& u, int slots)
        : environment_(environment) {
        Lanes<std::int32_t, N> begin;
        REALCAM_LANES
        for (int i = 0; i < slots; ++i) begin[i] = 0;
        choose_from_cdfs(environment.marginal_cdf, begin, environment.height, u.y, slots, row_);
        REALCAM_LANES
        for (int i = 0; i < slots; ++i) begin[i] = row_.index[i] * (environment.width + 1);
        choose_from_cdfs(environment.conditional_cdf, begin, environment.width, u.x, slots, column_);
        for (int i = 0; i < slots; ++i)
            radiance_.set(i, pixel_radiance(environment, {row_.index[i], column_.index[i]}));
    }

    REALCAM_INLINE LightSample operator[](int slot) const {
        return sample_in_pixel(environment_, row_[slot], column_[slot], radiance_[slot]);
    }

private:
    const EnvironmentView& environment_;
    CdfChoices<N> row_, column_;
    ColorLanes<N> radiance_;
};

/// Light samples, one LightSample per slot.
template <int N>
struct LightSamples {
    Vec3Lanes<float, N> direction;
    ColorLanes<N> irradiance;
    Lanes<float, N> distance, reach, pdf;  ///< all members: see LightSample

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

namespace light_samples_detail {

/// Returns a if the condition holds, else b, without branches.
REALCAM_INLINE LightSample select(bool condition, const LightSample& a, const LightSample& b) {
    using realcam::select;
    return {select(condition, a.direction, b.direction), select(condition, a.distance, b.distance),
            select(condition, a.reach, b.reach), select(condition, a.irradiance, b.irradiance),
            select(condition, a.pdf, b.pdf)};
}

/// Kind of the light that was picked for a slot, by the code that samples it.
enum class Source : std::int32_t {
    none,   ///< no light
    area,   ///< area light, in vector code
    sky,    ///< environment, in vector code
    other,  ///< another light, sampled one by one (PickedLights::others)
};

/// Lights that were picked for the slots.
template <int N>
struct PickedLights {
    Lanes<Source, N> source;
    Lanes<float, N> probability;  ///< probability of picking the light
    Vec2Lanes<float, N> u;  ///< random numbers in [0, 1) that remain after the choice, for the point on the light
    LightSamples<N> others;  ///< complete samples of Source::other
    // The AreaLight of Source::area:
    Vec3Lanes<float, N> corner, edge_u, edge_v, normal;
    ColorLanes<N> radiance;
    Lanes<float, N> area, margin;
    Lanes<std::int32_t, N> is_two_sided;
    Lanes<std::uint32_t, N> triangle, instance;
    bool any_area = false, any_sky = false, any_other = false;  ///< true if any slot has this source

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
        is_two_sided[lane] = light.is_two_sided;
        triangle[lane] = light.triangle;
        instance[lane] = light.instance;
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
        return {corner[lane],   edge_u[lane], edge_v[lane], normal[lane],   is_two_sided[lane],
                radiance[lane], area[lane],   margin[lane], triangle[lane], instance[lane]};
    }
};

}  // namespace light_samples_detail

/// Probabilities of the kinds of light at all surfaces of a block, as light_kinds computes them for one. operator[]
/// returns those of a slot. `count`: number of surfaces.
template <int N>
class LightKindsLanes {
public:
    template <class SurfacesT>
    REALCAM_INLINE LightKindsLanes(const SceneView& scene, SkySampling sky, const SurfacesT& surfaces, int count) {
        const int slots = whole_vectors<N>(count);
        Lanes<float, N> local = {}, suns = {};  // importances of point and area lights, and of suns
        if (count_light_kinds(scene) > 1) {
            if (scene.light_node_count > 0) {
                const LightNode all = scene.light_nodes[0];
                REALCAM_LANES
                for (int i = 0; i < slots; ++i)
                    local[i] = max_illuminance(all, {surfaces.position[i], surfaces.normal[i]});
            }
            for (int k = 0; k < scene.sun_count; ++k) {
                const SunLight sun = scene.suns[k];
                REALCAM_LANES
                for (int i = 0; i < slots; ++i) suns[i] += sun_importance(sun, surfaces.normal[i]);
            }
        }
        REALCAM_LANES
        for (int i = 0; i < slots; ++i) {
            const LightKinds kinds = light_kinds(scene, sky, local[i], suns[i]);
            even_[i] = kinds.shares.even;
            scale_[i] = kinds.shares.scale;
            local_[i] = kinds.local_probability;
            environment_[i] = kinds.environment_probability;
            is_apart_[i] = kinds.environment_is_separate;
        }
    }
    REALCAM_INLINE LightKinds operator[](int lane) const {
        return {{even_[lane], scale_[lane]}, local_[lane], environment_[lane], is_apart_[lane] != 0};
    }

private:
    Lanes<float, N> even_, scale_, local_, environment_;  ///< numbers of LightKinds
    Lanes<std::int32_t, N> is_apart_;  ///< LightKinds::environment_is_separate
};

namespace light_samples_detail {

/// Points on the area lights that were picked for the slots.
template <int N>
struct LightPoints {
    Vec2Lanes<float, N> barycentric;
    Lanes<std::int32_t, N> is_near;  ///< 1 if the triangle is so near that it is sampled by solid angle (is_near)
    Lanes<float, N> solid_angle;  ///< solid angle of the triangle, sr; only if is_near
};

/// Samples the points as sample_area does for one light.
template <int N, class SurfacesT>
REALCAM_INLINE void sample_light_points(const PickedLights<N>& picked, const SurfacesT& surfaces, int slots,
                                        LightPoints<N>& points) {
    using realcam::select;
    std::int32_t any_near = 0;
    REALCAM_LANES
    for (int i = 0; i < slots; ++i) {
        const bool is_near =
            (picked.source[i] == Source::area) & realcam::is_near(picked.area_light(i), surfaces.position[i]);
        points.is_near[i] = is_near ? 1 : 0;
        any_near |= points.is_near[i];
        points.barycentric.set(i, sample_triangle(picked.u[i]));
    }
    if (any_near == 0) return;
    REALCAM_LANES
    for (int i = 0; i < slots; ++i) {
        const SolidAngleSample near = sample_near(picked.area_light(i), surfaces.position[i], picked.u[i]);
        const bool is_near = points.is_near[i] != 0;
        const Vec2f far_point = points.barycentric[i];
        points.barycentric.set(i, {select(is_near, near.at.x, far_point.x), select(is_near, near.at.y, far_point.y)});
        points.solid_angle[i] = near.solid_angle;
    }
}

/// Returns true if 32-bit indices reach all entries of the environment map's tables, as EnvironmentSamples requires.
REALCAM_INLINE bool fits_lanes(const EnvironmentView& environment) {
    return !environment.pixels || std::int64_t{environment.height} * (environment.width + 1) < (1 << 30);
}

/// Chooses a point or area light for each surface. `seed(slot)`: random bits.
template <int N, class SurfacesT, class Seeds>
REALCAM_INLINE void choose_local_lights(const SceneView& scene, const LightKindsLanes<N>& kinds,
                                        const SurfacesT& surfaces, const PathState<N>& path, const PathNumbers<N>& u,
                                        const Seeds& seed, LightChoices<N>& chosen) {
    const int slots = whole_vectors<N>(path.count);
    Lanes<float, N> remaining_u;
    Lanes<std::uint32_t, N> seeds;
    for (int i = 0; i < slots; ++i) seeds[i] = seed(i);
    REALCAM_LANES
    for (int i = 0; i < slots; ++i) remaining_u[i] = remapped_random(u[i].x, kinds[i].local_probability);
    choose_lights<N>(
        scene,
        [&](int i) -> LightReceiver {
            return {surfaces.position[i], surfaces.normal[i], 0.0f, surfaces.lobe(i, -path.rays.direction[i])};
        },
        remaining_u, seeds, slots, chosen);
}

/// Picks a light for light sample `number` (0 or 1, below kLightSampleCount) of each path, as pick_light does for one.
template <SceneKind scene_kind, int N, class SurfacesT, class Seeds>
REALCAM_INLINE void pick_lights(const SceneView& scene, const LightKindsLanes<N>& kinds, int number,
                                const SurfacesT& surfaces, const PathState<N>& path, const PathNumbers<N>& u,
                                const Seeds& seed, PickedLights<N>& picked) {
    const int slots = whole_vectors<N>(path.count);
    for (int i = 0; i < slots; ++i) picked.source[i] = Source::none;  // unused slots, too
    LightChoices<N> local;
    if (number == 0 && scene.light_node_count > 0) choose_local_lights(scene, kinds, surfaces, path, u, seed, local);
    for (int i = 0; i < path.count; ++i) {
        if (!surfaces.is_in_lanes(i)) continue;
        const LightReceiver receiver = {surfaces.position[i], surfaces.normal[i], time_of<scene_kind>(path, i)};
        const LightPick pick = pick_light_by(scene, receiver, kinds[i], number, u[i], [&](float) { return local[i]; });
        if (!(pick.probability > 0.0f)) continue;
        picked.u.set(i, pick.u);
        picked.probability[i] = pick.probability;
        if (pick.kind == LightKind::area)
            picked.set_area(i, area_light_at<scene_kind>(scene, pick.index, receiver.time));
        else if (pick.kind == LightKind::environment && fits_lanes(scene.environment))
            picked.set_sky(i);
        else
            picked.set_other(i, sample_picked<scene_kind>(scene, receiver, pick));
    }
}

}  // namespace light_samples_detail

/// Draws light sample `number` (0 or 1, below kLightSampleCount) for each path whose surface is stored in lanes
/// (SurfacesT::is_in_lanes); other paths get a black sample with the surface normal as its direction. `u`,
/// `seed(slot)`: random numbers and random bits of each path, as in sample_light.
template <SceneKind scene_kind, int N, class SurfacesT, class Seeds>
REALCAM_INLINE void sample_lights(const SceneView& scene, const LightKindsLanes<N>& kinds, int number,
                                  const SurfacesT& surfaces, const PathState<N>& path, const PathNumbers<N>& u,
                                  const Seeds& seed, LightSamples<N>& samples) {
    using namespace light_samples_detail;
    PickedLights<N> picked;
    pick_lights<scene_kind>(scene, kinds, number, surfaces, path, u, seed, picked);
    const int count = path.count, slots = whole_vectors<N>(count);
    if (picked.any_area) {
        LightPoints<N> points;
        sample_light_points(picked, surfaces, slots, points);
        if constexpr (scene_kind != SceneKind::plain) {
            for (int i = 0; i < count; ++i)
                if (picked.source[i] == Source::area)
                    picked.radiance.set(
                        i, emitted_radiance<scene_kind>(scene, picked.area_light(i), points.barycentric[i].x,
                                                        points.barycentric[i].y));
        }
        REALCAM_LANES
        for (int i = 0; i < slots; ++i) {
            const AreaLight light = picked.area_light(i);
            const DirectionToLight to_light = direction_to_light(light, shines_on_both_sides<scene_kind>(light),
                                                                 surfaces.position[i], points.barycentric[i]);
            const bool is_near = points.is_near[i] != 0;
            // The inverse of the density.
            const float scale = select(is_near, points.solid_angle[i], 1.0f / to_light.pdf);
            samples.direction.set(i, to_light.direction);
            samples.irradiance.set(i, select(to_light.cosine > 0.0f, scale, 0.0f) * picked.radiance[i]);
            samples.distance[i] = to_light.distance;
            samples.reach[i] = to_light.reach;
            samples.pdf[i] = select(is_near, 1.0f / points.solid_angle[i], to_light.pdf);
        }
    }
    if (picked.any_sky) {
        const auto set = [&](int i, const LightSample& sky) {
            const bool is_sky = picked.source[i] == Source::sky;
            samples.set(i, select(is_sky, sky, samples[i]));
        };
        if (scene.environment.pixels) {
            const EnvironmentSamples<N> sky(scene.environment, picked.u, slots);
            REALCAM_LANES
            for (int i = 0; i < slots; ++i) set(i, sky[i]);
        } else {
            const Color radiance = scene.environment.constant;
            REALCAM_LANES
            for (int i = 0; i < slots; ++i) {
                const Vec3f direction = sample_cosine(surfaces.normal[i], picked.u[i]);
                const float pdf = cosine_pdf(surfaces.normal[i], direction);
                set(i, {direction, kFarAway, 1.0f, select(pdf > 0.0f, 1.0f / pdf, 0.0f) * radiance, pdf});
            }
        }
    }
    if (picked.any_other) {
        for (int i = 0; i < count; ++i)
            if (picked.source[i] == Source::other) samples.set(i, picked.others[i]);
    }
    // Slots without a light hold uninitialised memory, and a BSDF indexes tables by the direction.
    REALCAM_LANES
    for (int i = 0; i < slots; ++i) {
        const float probability = picked.probability[i];
        const bool is_picked = picked.source[i] != Source::none;
        samples.direction.set(i, select(is_picked, samples.direction[i], surfaces.normal[i]));
        samples.irradiance.set(
            i, select(is_picked, bounded_light((1.0f / probability) * samples.irradiance[i]), Color{0, 0, 0}));
        samples.pdf[i] = select(is_picked, probability * samples.pdf[i], kDelta);
    }
}

}  // namespace REALCAM_NAMESPACE
