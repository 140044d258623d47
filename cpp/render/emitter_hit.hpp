#pragma once
#include "../scene/light.hpp"
#include "../scene/surface_point.hpp"
#include "path_settings.hpp"
#include "traced_light_weight.hpp"

namespace REALCAM_NAMESPACE {

// Light is sampled in two ways: by the lights and by the BSDF. Each contribution is weighted by the densities of both
// (multiple importance sampling, Veach and Guibas 1995).

/// Limits the contribution of a path, if `limit` > 0.
REALCAM_INLINE Color clamped(Color c, float limit) {
    const float most = largest(c);
    return limit > 0.0f && most > limit ? (limit / most) * c : c;
}

template <SceneKind scene_kind, int N>
REALCAM_INLINE LightReceiver receiver_of(const PathState<N>& path, int lane) {
    LightLobe lobe;
    if constexpr (scene_kind != SceneKind::plain) lobe = path.receiver_lobe(lane);
    return {path.receiver_position[lane], path.receiver_normal[lane], time_of<scene_kind>(path, lane), lobe};
}

/// Sampling method of the environment at the surface that a ray left. `bounce`: at which the ray ends.
template <SceneKind scene_kind, int N>
REALCAM_INLINE SkySampling receiver_sky(const SceneView& scene, const PathSettings& settings, const PathState<N>& path,
                                        int bounce, int lane) {
    // A ray that passed surfaces which show only shadows left an earlier one.
    if constexpr (scene_kind == SceneKind::any) return path.receiver_sky[lane];
    if (bounce == 0) return SkySampling::chosen;  // straight from the lens (set_first_density)
    return sky_sampling(scene, goes_on(settings, bounce - 1), bounce == 1);
}

/// Light of the environment along the ray of a lane, with its MIS weight.
template <SceneKind scene_kind, int N>
REALCAM_INLINE Color environment_light(const SceneView& scene, const PathSettings& settings, const PathState<N>& path,
                                       int bounce, int lane) {
    const Vec3f direction = path.rays.direction[lane];
    const float pdf = path.pdf[lane];
    float weight = 1.0f;
    if (pdf >= 0.0f && pdf < kDelta)
        weight =
            mis_weight(pdf, environment_light_pdf(scene, receiver_sky<scene_kind>(scene, settings, path, bounce, lane),
                                                  receiver_of<scene_kind>(path, lane), direction));
    return (weight * path.throughput[lane]) * environment_radiance(scene.environment, direction);
}

/// Light of an environment's image, whose pixel the ray hits, with its MIS weight.
template <SceneKind scene_kind, int N>
REALCAM_INLINE Color environment_image_light(const SceneView& scene, const PathSettings& settings,
                                             const PathState<N>& path, int bounce, int lane, EnvironmentPixel pixel) {
    const float pdf = path.pdf[lane];
    float weight = 1.0f;
    if (pdf >= 0.0f && pdf < kDelta)
        weight = mis_weight(pdf, light_kinds(scene, receiver_sky<scene_kind>(scene, settings, path, bounce, lane),
                                             receiver_of<scene_kind>(path, lane))
                                         .environment_chance() *
                                     environment_image_pdf(scene.environment, pixel, path.rays.direction[lane]));
    return (weight * path.throughput[lane]) * pixel_radiance(scene.environment, pixel);
}

/// Light of the emitter at a hit along the ray of a lane, with its MIS weight.
template <SceneKind scene_kind, int N>
REALCAM_INLINE Color emitter_light(const SceneView& scene, const CameraView& camera, const PathSettings& settings,
                                   const PathState<N>& path, int bounce, int lane, Hit hit, const SurfacePoint& point) {
    const float pdf = path.pdf[lane];
    float weight = 1.0f;
    if (pdf == kFromFilm) {
        weight = seen_light_weight<scene_kind>(scene, camera, path, lane, hit, point);
    } else if (pdf < kDelta) {
        const LightReceiver receiver = receiver_of<scene_kind>(path, lane);
        const float cosine = -dot(path.rays.direction[lane], point.geometric_normal);
        const Vec3f offset = point.position - receiver.position;
        weight = mis_weight(
            pdf, emitter_light_pdf<scene_kind>(scene, receiver_sky<scene_kind>(scene, settings, path, bounce, lane),
                                               receiver, area_light_of(scene, hit), length(offset), cosine));
    }
    return (weight * path.throughput[lane]) * point.emission;
}

}  // namespace REALCAM_NAMESPACE
