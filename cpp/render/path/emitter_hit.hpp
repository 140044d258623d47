#pragma once
#include "../../camera/models/camera_view.hpp"
#include "../../math/sampling.hpp"
#include "../../scene/geometry/surface_point.hpp"
#include "../../scene/lights/light.hpp"
#include "path_settings.hpp"
#include "path_state.hpp"

namespace REALCAM_NAMESPACE {

// Emission that a path finds when its ray hits an emitter or leaves the scene, with the weight of multiple importance
// sampling (MIS, Veach and Guibas 1995, power heuristic). Two other methods may find the same light:
//
// - At a surface, lights are sampled directly (scatter_paths.hpp).
// - The image of a light is also found by light tracing (trace_lights.hpp). Both methods identify a light path by its
//   point on the light and its entry point into the lens. The density of pixel samples is replaced by its mean over the
//   film and the pupil: the estimate is unbiased with any weights that sum to one for each light path.

/// Plane through the lens's front vertex in which the entrance-pupil bounds of a light (TracedLight::entries) lie. All
/// vectors are in render space, in metres.
struct EntryPlane {
    Vec3f normal;  ///< unit vector towards the light
    Vec3f along, across;  ///< unit axes of TracedLight::entries
    Vec3f origin;  ///< the lens's front vertex
};

/// Returns the entry plane of a light for a camera at one time.
REALCAM_INLINE EntryPlane entry_plane(const CameraFrame& camera, float front_vertex_m, const TracedLight& light) {
    const auto to_scene = [&](Vec3f in_lens) {
        return in_lens.x * camera.right + in_lens.y * camera.up + in_lens.z * camera.backward;
    };
    return {to_scene(light.from), to_scene(light.along), to_scene(cross(light.from, light.along)),
            front_vertex(camera, front_vertex_m)};
}

/// Returns the density of light-traced samples over the mean density of pixel samples, for one light path: the expected
/// number of the former for each of the latter. `pdf`: density per square metre with which the point on the light is
/// sampled; `cosine`: cosine between the path and the light's surface normal; `distance`: from the light to the entry
/// point, m; `entry_cosine`: cosine between the path and the normal of the entry plane.
REALCAM_INLINE float light_tracing_density_ratio(const TracedLightsView& lights, const TracedLight& light, float pdf,
                                                 float cosine, float distance, float entry_cosine) {
    return lights.scale * light.probability * pdf * distance * distance /
           (light.entries.area() * cosine * entry_cosine);
}

/// Returns the MIS weight, against light tracing, of an emitter that a camera ray hits. 1 if the emitter is not traced,
/// or if the ray does not pass the light's entrance-pupil bounds.
template <SceneKind scene_kind, int N>
REALCAM_INLINE float camera_hit_weight(const SceneView& scene, const CameraView& camera, const PathState<N>& path,
                                       int slot, Hit hit, const SurfacePoint& point) {
    const TracedLightsView& lights = camera.traced_lights;
    if (lights.light_count == 0) return 1.0f;
    const std::int32_t area = area_light_of(scene, hit), light_index = lights.light_of_area[area];
    if (light_index < 0) return 1.0f;
    const TracedLight light = lights.lights[light_index];
    const float time = time_of<scene_kind>(path, slot);
    CameraFrame placement = camera;
    if constexpr (scene_kind == SceneKind::any) placement = camera_at(camera, time);
    placement = placement_for(camera, placement, point.position);
    const float area_m2 = area_light_at<scene_kind>(scene, area, time).area;
    const EntryPlane plane = entry_plane(placement, camera.front_vertex_m, light);
    const Vec3f direction = path.rays.direction[slot];
    const float entry_cosine = dot(direction, plane.normal);
    if (!(entry_cosine > 0.0f)) return 1.0f;
    // The entry point is computed from the light, because the ray may start anywhere on the line.
    const float distance = dot(point.position - plane.origin, plane.normal) / entry_cosine;
    const Vec3f entry = point.position - distance * direction - plane.origin;
    constexpr float kMmPerMetre = 1000.0f;
    if (!(distance > 0.0f) ||
        !light.entries.holds(kMmPerMetre * dot(entry, plane.along), kMmPerMetre * dot(entry, plane.across)))
        return 1.0f;
    const float cosine = std::fabs(dot(direction, point.geometric_normal));
    return mis_weight(1.0f, light_tracing_density_ratio(lights, light, lights.share_of_area[area] / area_m2, cosine,
                                                        distance, entry_cosine));
}

/// Scales the contribution of a path so that its largest channel does not exceed `limit`; a limit of 0 means none.
REALCAM_INLINE Color clamped(Color c, float limit) {
    const float maximum = largest(c);
    return limit > 0.0f && maximum > limit ? (limit / maximum) * c : c;
}

/// Returns the surface from which the ray in a slot starts, as a receiver of sampled light.
template <SceneKind scene_kind, int N>
REALCAM_INLINE LightReceiver receiver_of(const PathState<N>& path, int slot) {
    LightLobe lobe;
    if constexpr (scene_kind != SceneKind::plain) lobe = path.receiver_lobe(slot);
    return {path.receiver_position[slot], path.receiver_normal[slot], time_of<scene_kind>(path, slot), lobe};
}

/// Returns how light samples of the environment were taken at the surface from which the ray in a slot starts.
/// `bounce`: index of the bounce at which the ray ends.
template <SceneKind scene_kind, int N>
REALCAM_INLINE SkySampling receiver_sky(const SceneView& scene, const PathSettings& settings, const PathState<N>& path,
                                        int bounce, int slot) {
    // The stored value is needed here: shadow catchers pass a ray on, so that it may start at an earlier surface than
    // that of bounce - 1.
    if constexpr (scene_kind == SceneKind::any) return path.receiver_sky[slot];
    if (bounce == 0) return SkySampling::chosen;  // straight from the lens (set_first_density)
    return sky_sampling(scene, all_lobes_scatter(settings, bounce - 1), bounce == 1);
}

/// Returns the contribution of the environment along the ray in a slot, with its MIS weight.
template <SceneKind scene_kind, int N>
REALCAM_INLINE Color environment_light(const SceneView& scene, const PathSettings& settings, const PathState<N>& path,
                                       int bounce, int slot) {
    const Vec3f direction = path.rays.direction[slot];
    const float pdf = path.pdf[slot];
    float weight = 1.0f;
    if (pdf >= 0.0f && pdf < kDelta)
        weight =
            mis_weight(pdf, environment_light_pdf(scene, receiver_sky<scene_kind>(scene, settings, path, bounce, slot),
                                                  receiver_of<scene_kind>(path, slot), direction));
    return (weight * path.throughput[slot]) * environment_radiance(scene.environment, direction);
}

/// environment_light for an environment map. `pixel`: pixel of the map in the direction of the ray.
template <SceneKind scene_kind, int N>
REALCAM_INLINE Color environment_image_light(const SceneView& scene, const PathSettings& settings,
                                             const PathState<N>& path, int bounce, int slot, EnvironmentPixel pixel) {
    const float pdf = path.pdf[slot];
    float weight = 1.0f;
    if (pdf >= 0.0f && pdf < kDelta)
        weight = mis_weight(pdf, light_kinds(scene, receiver_sky<scene_kind>(scene, settings, path, bounce, slot),
                                             receiver_of<scene_kind>(path, slot))
                                         .environment_chance() *
                                     environment_image_pdf(scene.environment, pixel, path.rays.direction[slot]));
    return (weight * path.throughput[slot]) * pixel_radiance(scene.environment, pixel);
}

/// Returns the contribution of the emitter that the ray in a slot hits, with its MIS weight: against light tracing for
/// camera rays, against light samples otherwise. `point`: the surface point of `hit`.
template <SceneKind scene_kind, int N>
REALCAM_INLINE Color emitter_light(const SceneView& scene, const CameraView& camera, const PathSettings& settings,
                                   const PathState<N>& path, int bounce, int slot, Hit hit, const SurfacePoint& point) {
    const float pdf = path.pdf[slot];
    float weight = 1.0f;
    if (pdf == kFromFilm) {
        weight = camera_hit_weight<scene_kind>(scene, camera, path, slot, hit, point);
    } else if (pdf < kDelta) {
        const LightReceiver receiver = receiver_of<scene_kind>(path, slot);
        const float cosine = -dot(path.rays.direction[slot], point.geometric_normal);
        const Vec3f offset = point.position - receiver.position;
        weight = mis_weight(
            pdf, emitter_light_pdf<scene_kind>(scene, receiver_sky<scene_kind>(scene, settings, path, bounce, slot),
                                               receiver, area_light_of(scene, hit), length(offset), cosine));
    }
    return (weight * path.throughput[slot]) * point.emission;
}

}  // namespace REALCAM_NAMESPACE
