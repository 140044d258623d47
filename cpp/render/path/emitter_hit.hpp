#pragma once
#include "../../camera/models/camera_view.hpp"
#include "../../math/sampling.hpp"
#include "../../scene/geometry/surface_point.hpp"
#include "../../scene/lights/light.hpp"
#include "path_settings.hpp"
#include "path_state.hpp"

namespace REALCAM_NAMESPACE {

// The image of a light is found by samples of pixels that hit the light, and by samples that start at the light
// (trace_lights.hpp). Both identify a light path by its point on the light and its entry point into the lens, and each
// contribution is weighted by the densities of both methods there (Veach and Guibas 1995). For samples of pixels a mean
// density suffices: any weights are unbiased if both methods compute the same ones.

/// Plane of a light's entry rectangle. Axes in the scene, all unit.
struct EntryPlane {
    Vec3f from, along, across;
    Vec3f middle;  ///< the lens's front vertex
};

REALCAM_INLINE EntryPlane entry_plane(const CameraPlacement& camera, float front_vertex_m, const TracedLight& light) {
    const auto in_scene = [&](Vec3f lens) {
        return lens.x * camera.right + lens.y * camera.up + lens.z * camera.backward;
    };
    return {in_scene(light.from), in_scene(light.along), in_scene(cross(light.from, light.along)),
            front_vertex(camera, front_vertex_m)};
}

/// Number of samples from the light per sample of each pixel, for this light path. `cosine`, `distance`: at the light's
/// surface, of the path to the entry, m; `entry_cosine`: to the normal of the entry plane; `pdf`: density of the point
/// in samples from the light, per square metre.
REALCAM_INLINE float traced_samples(const TracedLightsView& lights, const TracedLight& light, float pdf, float cosine,
                                    float distance, float entry_cosine) {
    return lights.scale * light.probability * pdf * distance * distance /
           (light.entries.area() * cosine * entry_cosine);
}

/// MIS weight of an emitter's light that a ray hits straight from the film.
template <SceneKind scene_kind, int N>
REALCAM_INLINE float seen_light_weight(const SceneView& scene, const CameraView& camera, const PathState<N>& path,
                                       int slot, Hit hit, const SurfacePoint& point) {
    const TracedLightsView& lights = camera.traced_lights;
    if (lights.light_count == 0) return 1.0f;
    const std::int32_t area = area_light_of(scene, hit), number = lights.light_of_area[area];
    if (number < 0) return 1.0f;
    const TracedLight light = lights.lights[number];
    const float time = time_of<scene_kind>(path, slot);
    CameraPlacement placement = camera;
    if constexpr (scene_kind == SceneKind::any) placement = camera_at(camera, time);
    const float area_m2 = area_light_at<scene_kind>(scene, area, time).area;
    const EntryPlane plane = entry_plane(placement, camera.front_vertex_m, light);
    const Vec3f direction = path.rays.direction[slot];
    const float entry_cosine = dot(direction, plane.from);
    if (!(entry_cosine > 0.0f)) return 1.0f;
    // Measured from the light, because the ray may begin anywhere on the path.
    const float distance = dot(point.position - plane.middle, plane.from) / entry_cosine;
    const Vec3f entry = point.position - distance * direction - plane.middle;
    if (!(distance > 0.0f) ||
        !light.entries.holds(1000.0f * dot(entry, plane.along), 1000.0f * dot(entry, plane.across)))
        return 1.0f;
    const float cosine = std::fabs(dot(direction, point.geometric_normal));
    return mis_weight(
        1.0f, traced_samples(lights, light, lights.share_of_area[area] / area_m2, cosine, distance, entry_cosine));
}

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
