#pragma once
#include "../camera/dispersed_rays.hpp"
#include "../scene/light.hpp"
#include "../scene/make_bsdf.hpp"
#include "path_settings.hpp"
#include "path_state.hpp"

namespace REALCAM_NAMESPACE {

// Light is looked for in two ways, by a direction that the lights suggest and by one that the BSDF suggests, and what
// either finds is weighed by the densities with which both could have found it (Veach and Guibas 1995).

enum class RenderStage { lens, scene, other };

/// Veach's power heuristic: what counts of light that was found with one density, where the other way had the other.
/// With kDelta, all of it, because no other way finds it.
REALCAM_INLINE float mis_weight(float pdf, float other_pdf) {
    const float ratio = other_pdf / pdf;
    return 1.0f / (1.0f + ratio * ratio);
}

namespace advance_path_detail {

/// From this bounce on, dim paths are ended by chance, and those that are kept count more.
inline constexpr int kFirstRoulette = 3;

/// Ends a path with the probability that its throughput has lost.
template <int N>
REALCAM_INLINE void play_roulette(const SampleBlock<N>& block, int bounce, int lane, PathState<N>& path) {
    const Color throughput = path.throughput[lane];
    const float kept = largest(throughput) / path.weight[lane];
    if (!(kept < 1.0f)) return;
    const float u = block.random(lane, dimension::roulette + static_cast<std::uint32_t>(bounce)).x;
    if (u < kept)
        path.throughput.set(lane, (1.0f / kept) * throughput);
    else
        path.rays.active[lane] = 0;
}

/// `limit` > 0: of what a path may bring.
REALCAM_INLINE Color clamped(Color c, float limit) {
    const float most = largest(c);
    return limit > 0.0f && most > limit ? (limit / most) * c : c;
}

REALCAM_INLINE Color absorbed(Color absorption, float way) {
    return {std::exp(-way * absorption.r), std::exp(-way * absorption.g), std::exp(-way * absorption.b)};
}

/// Where a ray starts so as not to meet its own surface again: on the side to which it goes.
REALCAM_INLINE Vec3f ray_start(const SurfacePoint& point, Vec3f direction) {
    const float offset = dot(point.geometric_normal, direction) < 0.0f ? -point.self_offset : point.self_offset;
    return point.position + offset * point.geometric_normal;
}

/// The ray that tests whether a light is hidden.
template <int N>
REALCAM_INLINE void set_shadow_ray(const SurfacePoint& point, const LightSample& light, int lane,
                                   SceneRays<N>& shadow) {
    const Vec3f start = ray_start(point, light.direction);
    shadow.origin.set(lane, start);
    if (light.distance < kFarAway) {
        // From the start to the light, whose distance is then 1: a light may be as near as the offset. The ray
        // stops short of the light, which is itself in the scene.
        shadow.direction.set(lane, light.distance * light.direction - (start - point.position));
        shadow.far[lane] = light.reach > 0 ? light.reach : 0.0f;
    } else {
        shadow.direction.set(lane, light.direction);
        shadow.far[lane] = kFarAway;
    }
}

/// When a path goes through the scene, as a share of the exposure.
template <SceneKind scene_kind, int N>
REALCAM_INLINE float time_of(const PathState<N>& path, int lane) {
    if constexpr (scene_kind == SceneKind::any) return path.rays.time[lane];
    return 0.0f;
}

template <SceneKind scene_kind>
REALCAM_INLINE float depth_at(const CameraView& camera, Vec3f position, float time) {
    if constexpr (scene_kind == SceneKind::any) return depth_from(camera_at(camera, time), position);
    return depth_from(camera, position);
}

template <SceneKind scene_kind, int N>
REALCAM_INLINE LightReceiver receiver_of(const PathState<N>& path, int lane) {
    return {path.receiver_position[lane], path.receiver_normal[lane], time_of<scene_kind>(path, lane)};
}

/// Behind the dimensions of all random numbers.
inline constexpr std::uint32_t kFootprintSalt = 0x40000;

/// Of a ray from the film.
template <int N>
REALCAM_INLINE Footprint film_footprint(const CameraView& camera, const SampleBlock<N>& block, int lane) {
    const float pixel = 2.0f * camera.film_half_width / static_cast<float>(camera.width);
    const auto number = static_cast<float>(block.sample[lane]) + 1.0f;
    const float width = pixel / camera.thin.image_distance;
    return {width * width / number, unit_float(hash32(block.stream[lane] ^ block.sample[lane], kFootprintSalt))};
}

/// Light that the environment sends along the ray of a lane.
template <SceneKind scene_kind, int N>
REALCAM_INLINE Color environment_light(const SceneView& scene, const PathState<N>& path, int lane) {
    const Vec3f direction = path.rays.direction[lane];
    const float pdf = path.pdf[lane];
    float weight = 1.0f;
    if (pdf < kDelta)
        weight = mis_weight(pdf, environment_light_pdf(scene, receiver_of<scene_kind>(path, lane), direction));
    return (weight * path.throughput[lane]) * environment_radiance(scene.environment, direction);
}

/// Light that the emitter at a hit sends along the ray of a lane.
template <SceneKind scene_kind, int N>
REALCAM_INLINE Color emitter_light(const SceneView& scene, const PathState<N>& path, int lane, Hit hit,
                                   const SurfacePoint& point) {
    const float pdf = path.pdf[lane];
    float weight = 1.0f;
    if (pdf < kDelta) {
        const LightReceiver receiver = receiver_of<scene_kind>(path, lane);
        const float cosine = -dot(path.rays.direction[lane], point.geometric_normal);
        const Vec3f way = point.position - receiver.position;
        weight = mis_weight(
            pdf, emitter_light_pdf<scene_kind>(scene, receiver, area_light_of(scene, hit), length(way), cosine));
    }
    return (weight * path.throughput[lane]) * point.emission;
}

/// The numbers of a dimension: for many lanes all at once, which is vector code, also for those that have no use for
/// them. A GPU's thread draws them when it wants them, because it has no registers in which to keep them.
template <int N>
class Numbers {
public:
    REALCAM_INLINE Numbers(const SampleBlock<N>& block, std::uint32_t dimension)
        : block_(block), dimension_(dimension) {
        if constexpr (N > 1) {
            REALCAM_LANES
            for (int i = 0; i < N; ++i) kept_.set(i, block.random(i, dimension));
        }
    }
    REALCAM_INLINE Vec2f operator[](int lane) const {
        if constexpr (N > 1) return kept_[lane];
        return block_.random(lane, dimension_);
    }

private:
    const SampleBlock<N>& block_;
    std::uint32_t dimension_;
    Vec2Lanes<float, N> kept_;
};

/// A sample of one of the lights, by the illuminance that each would bring if nothing stood in between: one of eight
/// that sample_light draws, by its share of what they bring (resampling, Talbot et al. 2005), or of up to 64 where
/// those were all behind the surface. Black: no light.
template <SceneKind scene_kind>
REALCAM_INLINE LightSample light_by_illuminance(const SceneView& scene, LightReceiver receiver, std::uint32_t seed) {
    LightSample chosen{{0, 1, 0}, kFarAway, 1.0f, {0, 0, 0}, kDelta};
    float sum = 0.0f;
    for (int i = 0; i < 8 || (i < 64 && !(sum > 0.0f)); ++i) {
        const auto random = [&] { return unit_float(seed = hash32(seed)); };
        const Vec2f u = {random(), random()};
        const LightSample light = sample_light<scene_kind>(scene, receiver, u, hash32(seed));
        const float cosine = dot(receiver.normal, light.direction);
        const float illuminance = cosine > 0.0f ? cosine * luminance(light.irradiance) : 0.0f;
        sum += illuminance;
        if (random() * sum < illuminance) chosen = light;
    }
    return chosen;
}

/// What the paths of a block have met, on their way from one surface to the next.
template <int N>
struct Surfaces {
    SurfacePoint points[N];
    std::int32_t scatters[N];  ///< 1 where the path goes on from here
};

/// The LightKinds of surfaces. In plain scenes, whose surfaces are all opaque, what they share is found for all lanes
/// at once; a GPU's thread finds it when it is wanted.
template <SceneKind scene_kind, int N>
class SurfaceLightKinds {
public:
    REALCAM_INLINE SurfaceLightKinds(const SceneView& scene, const Surfaces<N>& surfaces) : scene_(scene) {
        if constexpr (kForAll) {
            if (scene.light_node_count == 0 || LightKinds::count_of(scene) < 2) return;
            Vec3Lanes<float, N> position, normal;
            for (int i = 0; i < N; ++i) {
                const bool is_there = surfaces.scatters[i] != 0;
                position.set(i, is_there ? surfaces.points[i].position : Vec3f{0, 0, 0});
                normal.set(i, is_there ? surfaces.points[i].normal : Vec3f{0, 0, 1});
            }
            const LightNode all = scene.light_nodes[0];
            REALCAM_LANES
            for (int i = 0; i < N; ++i) local_[i] = light_importance(all, {position[i], normal[i]});
        }
    }
    REALCAM_INLINE LightKinds at(int lane, LightReceiver receiver) const {
        if constexpr (kForAll) return LightKinds(scene_, receiver, [&] { return local_[lane]; });
        return LightKinds(scene_, receiver);
    }

private:
    static constexpr bool kForAll = scene_kind == SceneKind::plain && N > 1;

    const SceneView& scene_;
    alignas(kLaneAlignment<float, N>) float local_[kForAll ? N : 1];
};

/// Collects what comes along the rays, from emitters that they have met or from the environment, and makes the points
/// ready from which paths go on.
template <SceneKind scene_kind, int N>
REALCAM_INLINE void meet_surfaces(const SceneView& view, const CameraView& camera, const PathSettings& settings,
                                  const SampleBlock<N>& block, int bounce, const Hits<N>& hits, PathState<N>& path,
                                  PathResults<N>& results, Surfaces<N>& surfaces) {
    for (int i = 0; i < N; ++i) {
        surfaces.scatters[i] = 0;
        if (!path.rays.active[i]) continue;
        path.rays.active[i] = 0;
        const Hit hit = hits[i];
        const Vec3f direction = path.rays.direction[i];
        const float time = time_of<scene_kind>(path, i);
        const float limit = bounce > 0 ? settings.clamp * path.weight[i] : 0.0f;
        if (hit.triangle == kNoTriangle) {
            if (view.has_environment)
                results.irradiance.set(
                    i, results.irradiance[i] + clamped(environment_light<scene_kind>(view, path, i), limit));
            continue;
        }
        Footprint footprint;
        if constexpr (scene_kind != SceneKind::plain) {
            if (bounce == 0) footprint = film_footprint(camera, block, i);
        }
        SurfacePoint& point = surfaces.points[i];
        point = surface_point<scene_kind>(view, hit, path.rays.origin[i], direction, time, footprint);
        if constexpr (scene_kind != SceneKind::plain) {
            const Color absorption = path.absorption[i];
            if (!is_black(absorption))
                path.throughput.set(i, path.throughput[i] * absorbed(absorption, hit.distance * length(direction)));
        }
        if (!is_black(point.emission))
            results.irradiance.set(
                i, results.irradiance[i] + clamped(emitter_light<scene_kind>(view, path, i, hit, point), limit));
        if (bounce == 0) results.depth[i] = depth_at<scene_kind>(camera, point.position, time);
        surfaces.scatters[i] = bounce <= settings.max_bounces;
    }
}

}  // namespace advance_path_detail

/// Rays from the film through the lens.
template <LensKind lens_kind, SceneKind scene_kind, Effects effects = kNoEffects, int N>
REALCAM_HD inline void begin_paths(const CameraView& camera, const SampleBlock<N>& block,
                                   PathStateWith<N, effects>& path, PathResults<N>& results) {
    CameraRays<N> camera_rays;
    if constexpr (effects.dispersion)
        generate_dispersed_rays<lens_kind>(camera, block, path.wavelength_nm, path.place, path.shares, camera_rays);
    else
        generate_rays<lens_kind>(camera, block, camera_rays);
    if constexpr (scene_kind == SceneKind::any) expose_rays(camera, block, camera_rays, path.rays.time);
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        path.rays.origin.set(i, camera_rays.origin[i]);
        path.rays.direction.set(i, camera_rays.direction[i]);
        path.rays.far[i] = kFarAway;
        path.rays.active[i] = camera_rays.passed[i];
        path.weight[i] = camera_rays.weight[i];
        path.throughput.set(i, grey(camera_rays.weight[i]));
        path.pdf[i] = kDelta;
        path.absorption.set(i, {0, 0, 0});
        results.irradiance.set(i, {0, 0, 0});
        results.depth[i] = kFarAway;
        results.weight[i] = camera_rays.weight[i];
        results.sampled[i] = camera_rays.sampled[i];
        results.passed[i] = camera_rays.passed[i];
    }
}

/// Takes each path to the next surface, collects the light that reaches it there, and scatters it. Returns whether any
/// goes on. `SceneT` offers intersect(rays, hits) and occluded(rays, hidden) for N rays; `Probe` offers
/// enter(RenderStage) and costs nothing where nobody asks for the time.
template <SceneKind scene_kind, int N, class SceneT, class Probe>
REALCAM_HD inline bool advance_paths(const SceneView& view, const CameraView& camera, const PathSettings& settings,
                                     const SampleBlock<N>& block, int bounce, SceneT&& scene, Probe&& probe,
                                     PathState<N>& path, PathResults<N>& results) {
    using namespace advance_path_detail;
    SceneRays<N> shadow;
    Hits<N> hits;
    ColorLanes<N> unshadowed;
    Surfaces<N> surfaces;
    alignas(kLaneAlignment<std::int32_t, N>) std::int32_t hidden[N];
    std::int32_t darkens[N] = {};  // surfaces that show nothing but shadows

    const std::uint32_t first_dimension =
        dimension::first_bounce + static_cast<std::uint32_t>(bounce) * dimension::per_bounce;
    if constexpr (scene_kind == SceneKind::any) {
        number_rays(block, bounce, path.rays);
        for (int i = 0; i < N; ++i) {
            shadow.number[i] = shadow_ray_number(hash32(path.rays.number[i]));
            shadow.time[i] = path.rays.time[i];
        }
    }
    probe.enter(RenderStage::scene);
    scene.intersect(path.rays, hits);
    probe.enter(RenderStage::other);
    meet_surfaces<scene_kind>(view, camera, settings, block, bounce, hits, path, results, surfaces);
    if constexpr (N == 1) {  // else the compiler keeps in registers what only paths that go on need
        if (!surfaces.scatters[0]) return false;
    }
    const Numbers<N> light_numbers(block, first_dimension + dimension::light),
        scatter_numbers(block, first_dimension + dimension::scatter);
    const SurfaceLightKinds<scene_kind, N> kinds(view, surfaces);
    // After the last bounce, one more ray looks for the light that narrow lobes show.
    const bool is_last = bounce == settings.max_bounces;
    int alive = 0, lit = 0;
    for (int i = 0; i < N; ++i) {
        shadow.active[i] = 0;
        if (!surfaces.scatters[i]) continue;
        const SurfacePoint& point = surfaces.points[i];
        const Vec3f direction = path.rays.direction[i];
        const float time = time_of<scene_kind>(path, i);
        const float limit = bounce > 0 ? settings.clamp * path.weight[i] : 0.0f;
        const std::uint32_t seed = hash32(block.stream[i] ^ block.sample[i], first_dimension);
        if constexpr (scene_kind == SceneKind::any) {
            darkens[i] = point.material->only_shadows;
            if (darkens[i]) {
                // What is behind is seen as far as the light here is not hidden. The ray keeps its direction, and so
                // the density of that.
                const LightSample light =
                    light_by_illuminance<scene_kind>(view, {point.position, point.normal, time}, seed);
                set_shadow_ray(point, light, i, shadow);
                shadow.active[i] = !is_black(light.irradiance);
                lit |= shadow.active[i];
                unshadowed.set(i, {0, 0, 0});
                path.rays.origin.set(i, ray_start(point, direction));
                path.rays.active[i] = alive = 1;
                continue;
            }
        }
        auto bsdf = make_bsdf<scene_kind>(point, -direction);
        const LightReceiver receiver = {point.position, bsdf.is_opaque() ? point.normal : Vec3f{0, 0, 0}, time};
        const LightSample light =
            sample_light<scene_kind>(view, receiver, kinds.at(i, receiver), light_numbers[i], seed);
        const Color lambert_and_narrow = bsdf.eval(light.direction);
        const bool goes_on = !is_last && settings.transport == LightTransport::paths;
        // Where only narrow lobes send out a ray, Lambert's lobe sees light samples alone.
        Color seen;
        if (goes_on) {
            seen = mis_weight(light.pdf, bsdf.pdf(light.direction)) * lambert_and_narrow;
        } else {
            if (settings.transport == LightTransport::whitted)
                bsdf.keep_mirrors();
            else
                bsdf.keep_narrow_lobes();
            const Color narrow = bsdf.eval(light.direction);
            seen = lambert_and_narrow;
            if (!is_black(narrow)) seen += (mis_weight(light.pdf, bsdf.pdf(light.direction)) - 1.0f) * narrow;
        }
        seen *= path.throughput[i] * light.irradiance;
        set_shadow_ray(point, light, i, shadow);
        shadow.active[i] = !is_black(seen);
        lit |= shadow.active[i];
        unshadowed.set(i, clamped(seen, limit));

        const BsdfSample next = bsdf.sample(scatter_numbers[i], unit_float(seed));
        const Color throughput = path.throughput[i] * next.weight;
        path.throughput.set(i, throughput);
        path.rays.origin.set(i, ray_start(point, next.direction));
        path.rays.direction.set(i, next.direction);
        path.rays.active[i] = !is_black(throughput);
        path.pdf[i] = next.pdf;
        path.receiver_position.set(i, receiver.position);
        path.receiver_normal.set(i, receiver.normal);
        if constexpr (scene_kind != SceneKind::plain) {
            if (next.refracted) path.absorption.set(i, point.is_front ? point.material->absorption : Color{0, 0, 0});
        }
        if (path.rays.active[i] && bounce >= kFirstRoulette) play_roulette(block, bounce, i, path);
        alive |= path.rays.active[i];
    }
    if (lit) {
        probe.enter(RenderStage::scene);
        scene.occluded(shadow, hidden);
        probe.enter(RenderStage::other);
        for (int i = 0; i < N; ++i) {
            if (shadow.active[i] & !hidden[i]) results.irradiance.set(i, results.irradiance[i] + unshadowed[i]);
            if constexpr (scene_kind == SceneKind::any) {
                if (darkens[i] & shadow.active[i] & hidden[i]) path.rays.active[i] = 0;
            }
        }
    }
    return alive != 0;
}

}  // namespace REALCAM_NAMESPACE
