#pragma once
#include "met_light.hpp"
#include "path_settings.hpp"

namespace REALCAM_NAMESPACE {

/// What the paths of a block have met, on their way from one surface to the next.
template <int N>
struct Surfaces {
    SurfacePoint points[N];
    std::int32_t scatters[N];  ///< 1 where the path goes on from here

    REALCAM_INLINE void set(int lane, const SurfacePoint& point) { points[lane] = point; }
};

/// Likewise in a plain scene, for vector code.
template <int N>
struct PlainSurfaces {
    Vec3Lanes<float, N> position, geometric_normal, normal;
    ColorLanes<N> diffuse, phong;
    alignas(kLaneAlignment<float, N>) float self_offset[N], shininess[N];
    alignas(kLaneAlignment<std::int32_t, N>) std::int32_t scatters[N];
    bool has_phong = false;  ///< any of them

    REALCAM_INLINE void set(int lane, const SurfacePoint& point) {
        position.set(lane, point.position);
        geometric_normal.set(lane, point.geometric_normal);
        normal.set(lane, point.normal);
        diffuse.set(lane, point.diffuse);
        phong.set(lane, point.material->specular);
        self_offset[lane] = point.self_offset;
        shininess[lane] = point.material->shininess;
        has_phong |= !is_black(point.material->specular);
    }
    REALCAM_INLINE SurfacePlace place(int lane) const {
        return {position[lane], geometric_normal[lane], self_offset[lane]};
    }
};

namespace meet_surfaces_detail {

REALCAM_INLINE Color absorbed(Color absorption, float way) {
    return {std::exp(-way * absorption.r), std::exp(-way * absorption.g), std::exp(-way * absorption.b)};
}

template <SceneKind scene_kind>
REALCAM_INLINE float depth_at(const CameraView& camera, Vec3f position, float time) {
    if constexpr (scene_kind == SceneKind::any) return depth_from(camera_at(camera, time), position);
    return depth_from(camera, position);
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

}  // namespace meet_surfaces_detail

/// Collects what comes along the rays, from emitters that they have met or from the environment, and makes the points
/// ready from which paths go on.
template <SceneKind scene_kind, int N, class SurfacesT>
REALCAM_INLINE void meet_surfaces(const SceneView& view, const CameraView& camera, const PathSettings& settings,
                                  const SampleBlock<N>& block, int bounce, const Hits<N>& hits, PathState<N>& path,
                                  PathResults<N>& results, SurfacesT& surfaces) {
    using namespace meet_surfaces_detail;
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
        const SurfacePoint point = surface_point<scene_kind>(view, hit, path.rays.origin[i], direction, time, [&] {
            return bounce == 0 ? film_footprint(camera, block, i) : Footprint{};
        });
        surfaces.set(i, point);
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

}  // namespace REALCAM_NAMESPACE
