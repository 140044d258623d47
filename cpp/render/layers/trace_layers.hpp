#pragma once
#include <limits>

#include "../../camera/models/pixel_centre_rays.hpp"
#include "../../scene/materials/make_bsdf.hpp"
#include "../path/path_state.hpp"
#include "layer_sum.hpp"

namespace REALCAM_NAMESPACE {

namespace trace_layers_detail {

/// Traces the camera rays that passed the lens to their first surfaces. `rays.number` and `rays.time` must be set.
template <int N, class SceneT>
REALCAM_HD inline void trace_to_surfaces(const CameraRays<N>& camera_rays, SceneT&& scene, SceneRays<N>& rays,
                                         Hits<N>& hits) {
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        rays.origin.set(i, camera_rays.origin[i]);
        rays.direction.set(i, camera_rays.direction[i]);
        rays.far[i] = kFarAway;
        rays.active[i] = camera_rays.passed[i];
    }
    scene.intersect(rays, hits);
}

/// Returns the diameter of the circle of confusion at a depth from the film, mm.
REALCAM_INLINE float circle_at(const CameraView& camera, float depth_m) {
    return circle_diameter(camera.circle, 1000.0f * (depth_m - camera.front_vertex_m));
}

}  // namespace trace_layers_detail

/// Finds the first surfaces of the samples of a block, whose camera rays are those of render_samples. `scene`: see
/// advance_paths.
template <int N, class SceneT>
REALCAM_HD inline void trace_layers(const SceneView& view, const CameraView& camera, const SampleBlock<N>& block,
                                    SceneT&& scene, LayerResults<N>& results) {
    using namespace trace_layers_detail;
    CameraRays<N> camera_rays;
    SceneRays<N> rays;
    Hits<N> hits;
    if (needs_general_lens_code(camera))
        generate_exposed_rays<LensKind::any>(camera, block, camera_rays, rays.time);
    else
        generate_exposed_rays<LensKind::rotational>(camera, block, camera_rays, rays.time);
    for (int i = 0; i < N; ++i) rays.number[i] = ray_number(block, i, 0);
    trace_to_surfaces(camera_rays, scene, rays, hits);
    for (int i = 0; i < N; ++i) {
        results.weight[i] = camera_rays.passed[i] ? camera_rays.weight[i] : 0.0f;
        results.met[i] = 0;
        if (!camera_rays.passed[i]) continue;
        const Hit hit = hits[i];
        if (hit.triangle == kNoTriangle) {
            results.circle_mm[i] = circle_at(camera, kFarAway);
            continue;
        }
        const SurfacePoint point =
            surface_point<SceneKind::any>(view, hit, rays.origin[i], rays.direction[i], rays.time[i]);
        results.met[i] = 1;
        results.normal.set(i, point.normal);
        results.albedo.set(i, albedo_of(point));
        results.circle_mm[i] = circle_at(camera, depth_from(camera_at(camera, rays.time[i]), point.position));
    }
}

/// Finds the nearest surface on the ray of each pixel's centre (pixel_centre_rays). `block`: one lane per pixel; sample
/// indices and random numbers are not used.
template <int N, class SceneT>
REALCAM_HD inline void trace_pixel_centres(const SceneView& view, const CameraView& camera, const SampleBlock<N>& block,
                                           SceneT&& scene, PixelCentreSurface (&surfaces)[N]) {
    using namespace trace_layers_detail;
    CameraRays<N> camera_rays;
    SceneRays<N> rays;
    Hits<N> hits;
    pixel_centre_rays(camera, block, camera_rays, rays.time);
    // One ray stands for the whole pixel, so that partly opaque surfaces must not depend on chance.
    for (int i = 0; i < N; ++i) rays.number[i] = kDeterministicRay;
    trace_to_surfaces(camera_rays, scene, rays, hits);
    for (int i = 0; i < N; ++i) {
        surfaces[i] = {
            camera_rays.passed[i] ? std::numeric_limits<float>::infinity() : std::numeric_limits<float>::quiet_NaN(),
            {0, 0, 0},
            kNoTriangle,
            kNoInstance,
            0,
            rays.direction[i]};
        if (!camera_rays.passed[i] || hits.triangle[i] == kNoTriangle) continue;
        const Hit hit = hits[i];
        const SurfacePoint point =
            surface_point<SceneKind::any>(view, hit, rays.origin[i], rays.direction[i], rays.time[i]);
        surfaces[i] = {
            depth_from(camera_at(camera, rays.time[i]), point.position),  point.normal,  hit.triangle, hit.instance,
            mesh_of(view, hit.instance).triangles[hit.triangle].material, point.position};
    }
}

}  // namespace REALCAM_NAMESPACE
