#pragma once
#include "../camera/generate_rays.hpp"
#include "path_state.hpp"

namespace REALCAM_NAMESPACE {

/// Sets the density against which the light that a ray hits straight from the lens is weighted, if that light is also
/// sampled from the lights (splat_ghosts.hpp): as if the ray's direction had been sampled with this density at the
/// front vertex.
template <SceneKind scene_kind, int N>
REALCAM_INLINE void set_first_density(const CameraView& camera, float density, int lane, PathState<N>& path) {
    Vec3f front = front_vertex(camera, camera.front_vertex_m);
    if constexpr (scene_kind == SceneKind::any) {
        front = front_vertex(camera_at(camera, path.rays.time[lane]), camera.front_vertex_m);
        path.receiver_sky[lane] = SkySampling::chosen;
    }
    if constexpr (scene_kind != SceneKind::plain) path.set_receiver_lobe(lane, {});
    path.pdf[lane] = density;
    path.receiver_position.set(lane, front);
    path.receiver_normal.set(lane, {0, 0, 0});
}

/// Starts paths with the rays that have left the lens.
template <int N>
REALCAM_INLINE void start_paths(const CameraRays<N>& camera_rays, PathState<N>& path, PathResults<N>& results) {
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        path.rays.origin.set(i, camera_rays.origin[i]);
        path.rays.direction.set(i, camera_rays.direction[i]);
        path.rays.far[i] = kFarAway;
        path.rays.active[i] = camera_rays.passed[i];
        path.weight[i] = camera_rays.weight[i];
        path.throughput.set(i, grey(camera_rays.weight[i]));
        path.pdf[i] = kFromFilm;
        path.absorption.set(i, {0, 0, 0});
        results.irradiance.set(i, {0, 0, 0});
        results.depth[i] = kFarAway;
        results.weight[i] = camera_rays.weight[i];
        results.sampled[i] = camera_rays.sampled[i];
        results.passed[i] = camera_rays.passed[i];
    }
}

}  // namespace REALCAM_NAMESPACE
