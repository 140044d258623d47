#pragma once
#include "../camera/generate_rays.hpp"
#include "../scene/shade.hpp"

namespace REALCAM_NAMESPACE {

/// Rays for traversal. Lanes with active 0 are left out.
template <int N>
struct SceneRays {
    Vec3Lanes<float, N> origin, direction;
    alignas(kLaneAlignment<float, N>) float far[N];  ///< how far along the ray to look, in lengths of the direction
    alignas(kLaneAlignment<std::int32_t, N>) std::int32_t active[N];
};

/// What a block of samples saw. Irradiance per sample: its mean over a pixel's samples is the pixel's irradiance.
template <int N>
struct SampleResults {
    Vec3Lanes<float, N> irradiance;
    alignas(kLaneAlignment<float, N>) float depth[N];  ///< of the first hit along the camera's axis from the film,
                                                       ///< metres; < 0: none
    alignas(kLaneAlignment<std::int32_t, N>) std::int32_t sampled[N], passed[N];
};

enum class RenderStage { lens, scene, other };

/// Takes one block of samples from the film, through the lens, to the scene and its lights: the whole path.
///
/// `SceneT` offers intersect(rays, hits) and occluded(rays, hidden) for N rays; `Probe` offers enter(RenderStage) and
/// costs nothing where nobody asks for the time. `lens_kind`: any, or the lens's own. A GPU thread runs this with N
/// = 1.
template <LensKind lens_kind = LensKind::any, int N, class SceneT, class Probe>
REALCAM_HD inline void render_samples(const SceneView& view, const CameraView& camera, int max_bounces,
                                      const SampleBlock<N>& block, SceneT&& scene, Probe&& probe,
                                      SampleResults<N>& results) {
    CameraRays<N> camera_rays;
    SceneRays<N> rays, shadow;
    Hits<N> hits;
    Vec3Lanes<float, N> throughput, unshadowed;
    alignas(kLaneAlignment<std::int32_t, N>) std::int32_t hidden[N];

    probe.enter(RenderStage::lens);
    generate_rays<lens_kind>(camera, block, camera_rays);
    probe.enter(RenderStage::other);
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        rays.origin.set(i, camera_rays.origin[i]);
        rays.direction.set(i, camera_rays.direction[i]);
        rays.far[i] = kFarAway;
        rays.active[i] = camera_rays.passed[i];
        const float weight = camera_rays.weight[i];
        throughput.set(i, {weight, weight, weight});
        results.irradiance.set(i, {0, 0, 0});
        results.depth[i] = -1.0f;
        results.sampled[i] = camera_rays.sampled[i];
        results.passed[i] = camera_rays.passed[i];
    }

    for (int bounce = 0;; ++bounce) {
        probe.enter(RenderStage::scene);
        scene.intersect(rays, hits);
        probe.enter(RenderStage::other);
        const bool last = bounce == max_bounces;
        const std::uint32_t dimension =
            dimension::first_bounce + static_cast<std::uint32_t>(bounce) * dimension::per_bounce;
        int alive = 0;
        for (int i = 0; i < N; ++i) {
            shadow.active[i] = 0;
            if (!rays.active[i]) continue;
            const Hit hit = hits[i];
            const Vec3f direction = rays.direction[i];
            if (hit.triangle == kNoTriangle) {
                rays.active[i] = 0;
                // Later bounces have met the environment's light as a light sample.
                if (bounce == 0 && view.has_environment)
                    results.irradiance.set(i, throughput[i] * environment_radiance(view.environment, direction));
                continue;
            }
            const SurfacePoint point = surface_point(view, hit, rays.origin[i], direction);
            if (bounce == 0) {
                results.irradiance.set(i, throughput[i] * point.emission);
                results.depth[i] = dot(camera.position - point.position, camera.backward);
            }
            const Vec3f start = point.position + point.self_offset * point.geometric_normal;
            const LightSample light = sample_light(view, point, block.random(i, dimension + dimension::light));
            const Vec3f seen = throughput[i] * lit_radiance(point, -direction, light);
            shadow.origin.set(i, start);
            if (light.distance < kFarAway) {
                // From the start to the light, whose distance is then 1: a light may be as near as the offset. The ray
                // stops short of the light, which is itself in the scene.
                shadow.direction.set(i, light.distance * light.direction - (start - point.position));
                shadow.far[i] = light.reach > 0 ? light.reach : 0.0f;
            } else {
                shadow.direction.set(i, light.direction);
                shadow.far[i] = kFarAway;
            }
            shadow.active[i] = seen.x + seen.y + seen.z > 0;
            unshadowed.set(i, seen);
            if (last) {
                rays.active[i] = 0;
                continue;
            }
            const Scatter next = scatter(point, -direction, block.random(i, dimension + dimension::scatter));
            const Vec3f dimmed = throughput[i] * next.factor;
            throughput.set(i, dimmed);
            rays.origin.set(i, start);
            rays.direction.set(i, next.direction);
            rays.active[i] = dimmed.x + dimmed.y + dimmed.z > 0;
            alive |= rays.active[i];
        }
        probe.enter(RenderStage::scene);
        scene.occluded(shadow, hidden);
        probe.enter(RenderStage::other);
        for (int i = 0; i < N; ++i)
            if (shadow.active[i] & !hidden[i]) results.irradiance.set(i, results.irradiance[i] + unshadowed[i]);
        if (!alive) break;
    }
}

}  // namespace REALCAM_NAMESPACE
