#pragma once
#include "../../scene/lights/attenuation.hpp"
#include "emitter_hit.hpp"
#include "path_settings.hpp"

namespace REALCAM_NAMESPACE {

/// Surfaces that the paths of a block have hit, one SurfacePoint per slot. All surface types of this folder have the
/// same set() and, for vector code, position, normal, lobe() and is_in_lanes(). Those of SceneKind::any have
/// set_scattering_point().
template <int N>
struct Surfaces {
    SurfacePoint points[N];

    REALCAM_INLINE void set(int slot, const SurfacePoint& point) { points[slot] = point; }
    /// Stores a point at which a medium scatters the path: a point without a material. `direction`: of the path, unit.
    REALCAM_INLINE void set_scattering_point(int slot, Vec3f position, Vec3f direction) {
        points[slot].position = position;
        points[slot].normal = points[slot].geometric_normal = -direction;
        points[slot].self_offset = 0.0f;
        points[slot].material = nullptr;
    }
};

/// Surfaces of a plain scene, stored in lanes: only the members of SurfacePoint that Lambert and Phong lobes need.
template <int N>
struct PlainSurfaces {
    Vec3Lanes<float, N> position, geometric_normal, normal;
    ColorLanes<N> diffuse, phong;
    Lanes<float, N> self_offset, shininess;  ///< see SurfacePoint and Material
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
    /// Lobe by which lights are chosen: Lambertian.
    REALCAM_INLINE LightLobe lobe(int, Vec3f) const { return {}; }
    /// Returns true if a surface is stored in lanes.
    REALCAM_INLINE bool is_in_lanes(int) const { return true; }
};

namespace shade_hits_detail {

/// Returns the depth of a position along the camera's axis from the film at a time, in metres.
template <SceneKind scene_kind>
REALCAM_INLINE float depth_at(const CameraView& camera, Vec3f position, float time) {
    if constexpr (scene_kind == SceneKind::any) return depth_from(camera_at(camera, time), position);
    return depth_from(camera, position);
}

/// Index of the random bits for the footprint; larger than the dimensions of all other random numbers.
inline constexpr std::uint32_t kFootprintBits = 0x40000;

/// Returns the footprint of a camera ray for texture filtering: the area of a pixel, seen from the lens, divided by the
/// index of the sample, because the n samples of a pixel together resolve details of 1/n of its area.
template <int N>
REALCAM_INLINE Footprint film_footprint(const CameraView& camera, const SampleBlock<N>& block, int lane) {
    const float pixel = 2.0f * camera.film_half_width / static_cast<float>(camera.width);
    const auto sample_count = static_cast<float>(block.sample[lane]) + 1.0f;
    const float width = pixel / camera.thin.image_distance;
    return {width * width / sample_count, unit_float(block.bits(lane, kFootprintBits))};
}

/// Adds the radiance of an environment map along rays that have hit no surface, and ends their paths. Two loops, so
/// that many reads from the map are in flight at once.
template <SceneKind scene_kind, int N>
REALCAM_INLINE void end_at_environment_map(const SceneView& view, const PathSettings& settings, int bounce,
                                           const Hits<N>& hits, PathState<N>& path, PathResults<N>& results) {
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

/// Ends or shades each active path after its ray was traced: adds the emission of the surface or the environment that
/// the ray has hit, attenuates the throughput by glass that does not scatter light, and writes the surface points of
/// continuing paths to `surfaces`. These paths move to the first slots, and path.count becomes their number. `bounce`:
/// 0 for camera rays.
template <SceneKind scene_kind, int N, class SurfacesT>
REALCAM_INLINE void shade_hits(const SceneView& view, const CameraView& camera, const PathSettings& settings,
                               const SampleBlock<N>& block, int bounce, const Hits<N>& hits, PathState<N>& path,
                               PathResults<N>& results, SurfacesT& surfaces) {
    using namespace shade_hits_detail;
    if constexpr (N > 1) {
        if (view.has_environment && view.environment.pixels)
            end_at_environment_map<scene_kind>(view, settings, bounce, hits, path, results);
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
        if constexpr (scene_kind == SceneKind::any) {
            if (hit.triangle == kScatteredInMedium) {
                surfaces.set_scattering_point(N > 1 ? path.count : 0, path.rays.origin[i] + hit.distance * direction,
                                              direction);
                path.template move<scene_kind>(i, path.count++);
                continue;
            }
        }
        const SurfacePoint point = surface_point<scene_kind>(view, hit, path.rays.origin[i], direction, time, [&] {
            return bounce == 0 ? film_footprint(camera, block, lane) : Footprint{};
        });
        surfaces.set(N > 1 ? path.count : 0, point);
        if constexpr (scene_kind != SceneKind::plain) {
            const Material* interior = path.interior[i];
            if (interior && !is_black(interior->absorption) &&
                !(scene_kind == SceneKind::any && interior->has_scattering_interior()))
                path.throughput.set(
                    i, path.throughput[i] * transmittance(interior->absorption, hit.distance * length(direction)));
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
