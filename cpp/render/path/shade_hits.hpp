#pragma once
#include "emitter_hit.hpp"
#include "path_settings.hpp"

namespace REALCAM_NAMESPACE {

/// Surfaces that the paths of a block have hit.
template <int N>
struct Surfaces {
    SurfacePoint points[N];

    REALCAM_INLINE void set(int slot, const SurfacePoint& point) { points[slot] = point; }
};

/// Surfaces of a plain scene, in lanes.
template <int N>
struct PlainSurfaces {
    Vec3Lanes<float, N> position, geometric_normal, normal;
    ColorLanes<N> diffuse, phong;
    Lanes<float, N> self_offset, shininess;
    bool has_phong = false;  ///< true if any surface has a Phong lobe

    REALCAM_INLINE void set(int slot, const SurfacePoint& point) {
        position.set(slot, point.position);
        geometric_normal.set(slot, point.geometric_normal);
        normal.set(slot, point.normal);
        diffuse.set(slot, point.diffuse);
        phong.set(slot, point.material->specular);
        self_offset[slot] = point.self_offset;
        shininess[slot] = point.material->shininess;
        has_phong |= !is_black(point.material->specular);
    }
    REALCAM_INLINE RaySpawnPoint operator[](int slot) const {
        return {position[slot], geometric_normal[slot], self_offset[slot]};
    }
    REALCAM_INLINE LightLobe lobe(int, Vec3f) const { return {}; }
    REALCAM_INLINE bool is_in_lanes(int) const { return true; }
};

namespace shade_hits_detail {

REALCAM_INLINE Color absorbed(Color absorption, float distance) {
    return {std::exp(-distance * absorption.r), std::exp(-distance * absorption.g), std::exp(-distance * absorption.b)};
}

template <SceneKind scene_kind>
REALCAM_INLINE float depth_at(const CameraView& camera, Vec3f position, float time) {
    if constexpr (scene_kind == SceneKind::any) return depth_from(camera_at(camera, time), position);
    return depth_from(camera, position);
}

/// Salt for the footprint's random bits, beyond the dimensions of all random numbers.
inline constexpr std::uint32_t kFootprintSalt = 0x40000;

/// The footprint of a ray from the film.
template <int N>
REALCAM_INLINE Footprint film_footprint(const CameraView& camera, const SampleBlock<N>& block, int lane) {
    const float pixel = 2.0f * camera.film_half_width / static_cast<float>(camera.width);
    const auto number = static_cast<float>(block.sample[lane]) + 1.0f;
    const float width = pixel / camera.thin.image_distance;
    return {width * width / number, unit_float(block.bits(lane, kFootprintSalt))};
}

/// Adds the light of an environment's image along rays that have hit nothing, and ends these. Two loops, so that memory
/// is read for many pixels at once.
template <SceneKind scene_kind, int N>
REALCAM_INLINE void end_at_image(const SceneView& view, const PathSettings& settings, int bounce, const Hits<N>& hits,
                                 PathState<N>& path, PathResults<N>& results) {
    std::int32_t ending[N], count = 0;
    EnvironmentPixel pixels[N];
    for (int i = 0; i < path.count; ++i) {
        if (!path.rays.active[i] || hits.triangle[i] != kNoTriangle) continue;
        path.rays.active[i] = 0;
        pixels[count] = environment_pixel(view.environment, path.rays.direction[i]);
        ending[count++] = i;
    }
    for (int k = 0; k < count; ++k) {
        const int i = ending[k], lane = path.lane(i);
        const float limit = bounce > 0 ? settings.clamp * path.weight[i] : 0.0f;
        const Color light = environment_image_light<scene_kind>(view, settings, path, bounce, i, pixels[k]);
        results.irradiance.set(lane, results.irradiance[lane] + clamped(light, limit));
    }
}

}  // namespace shade_hits_detail

/// Adds the light of hit emitters and of the environment, and sets the surface points from which paths continue.
/// Continuing paths move to the first slots.
template <SceneKind scene_kind, int N, class SurfacesT>
REALCAM_INLINE void shade_hits(const SceneView& view, const CameraView& camera, const PathSettings& settings,
                               const SampleBlock<N>& block, int bounce, const Hits<N>& hits, PathState<N>& path,
                               PathResults<N>& results, SurfacesT& surfaces) {
    using namespace shade_hits_detail;
    if constexpr (N > 1) {
        if (view.has_environment && view.environment.pixels)
            end_at_image<scene_kind>(view, settings, bounce, hits, path, results);
    }
    const int slots = path.slots();
    path.count = 0;
    for (int i = 0; i < slots; ++i) {
        if (!path.rays.active[i]) continue;
        path.rays.active[i] = 0;
        const Hit hit = hits[i];
        const int lane = path.lane(i);
        const Vec3f direction = path.rays.direction[i];
        const float time = time_of<scene_kind>(path, i);
        const float limit = bounce > 0 ? settings.clamp * path.weight[i] : 0.0f;
        if (hit.triangle == kNoTriangle) {
            if (view.has_environment)
                results.irradiance.set(
                    lane, results.irradiance[lane] +
                              clamped(environment_light<scene_kind>(view, settings, path, bounce, i), limit));
            continue;
        }
        const SurfacePoint point = surface_point<scene_kind>(view, hit, path.rays.origin[i], direction, time, [&] {
            return bounce == 0 ? film_footprint(camera, block, lane) : Footprint{};
        });
        surfaces.set(N > 1 ? path.count : 0, point);
        if constexpr (scene_kind != SceneKind::plain) {
            const Color absorption = path.absorption[i];
            if (!is_black(absorption))
                path.throughput.set(i, path.throughput[i] * absorbed(absorption, hit.distance * length(direction)));
        }
        if (!is_black(point.emission))
            results.irradiance.set(
                lane,
                results.irradiance[lane] +
                    clamped(emitter_light<scene_kind>(view, camera, settings, path, bounce, i, hit, point), limit));
        if (bounce == 0) results.depth[lane] = depth_at<scene_kind>(camera, point.position, time);
        if (bounce <= settings.max_bounces) path.template move<scene_kind>(i, path.count++);
    }
}

}  // namespace REALCAM_NAMESPACE
