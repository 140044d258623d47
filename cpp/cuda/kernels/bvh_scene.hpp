#pragma once
#include "../../bvh/traverse_scene.hpp"
#include "../../render/path/render_samples.hpp"

namespace REALCAM_NAMESPACE {

/// The `scene` argument of render_samples on a GPU: traces one ray per thread. `instanced`: true if the scene has
/// instances.
template <SceneKind scene_kind, bool instanced>
struct BvhScene {
    const SceneView& scene;
    const SceneBvhView& bvh;
    std::uint32_t rays_traced;  ///< counter, incremented by each function

    /// Finds the closest hit of an active ray.
    REALCAM_INLINE void intersect(const SceneRays<1>& rays, Hits<1>& hits) {
        if (!rays.active[0]) return;
        const Hit hit = closest_hit<instanced>(bvh, rays.origin[0], rays.direction[0], rays.far[0], scene_ray(rays));
        hits.distance[0] = hit.distance;
        hits.triangle[0] = hit.triangle;
        hits.u[0] = hit.u;
        hits.v[0] = hit.v;
        hits.instance[0] = hit.instance;
        ++rays_traced;
    }
    /// Sets `hidden` to 1 if the ray is active and occluded, else to 0.
    REALCAM_INLINE void occluded(const SceneRays<1>& rays, std::int32_t (&hidden)[1]) {
        hidden[0] = 0;
        if (!rays.active[0]) return;
        hidden[0] = any_hit<instanced>(bvh, rays.origin[0], rays.direction[0], rays.far[0], scene_ray(rays));
        ++rays_traced;
    }

private:
    /// Returns what the traversal must know of the ray: time and random bits, if the scene kind needs them.
    REALCAM_INLINE auto scene_ray(const SceneRays<1>& rays) const {
        if constexpr (scene_kind == SceneKind::any)
            return AnySceneRay{scene, rays.number[0], rays.time[0]};
        else
            return PlainSceneRay();
    }
};

}  // namespace REALCAM_NAMESPACE
