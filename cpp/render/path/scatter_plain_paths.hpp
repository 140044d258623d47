#pragma once
#include "light_samples.hpp"
#include "scatter_paths.hpp"

namespace REALCAM_NAMESPACE {

namespace scatter_plain_paths_detail {

/// Direct light for surfaces with only a Lambertian lobe: set_direct_light for all slots. `is_weighted`: true if BSDF
/// samples find the light, too, so that light samples get a MIS weight; a template parameter, because gcc does not
/// vectorise a loop that tests it.
template <bool is_weighted, int N>
REALCAM_INLINE void set_direct_light_lambert(const PathSettings& settings, int bounce, const PlainSurfaces<N>& surfaces,
                                             const LightSamples<N>& lights, const PathState<N>& path,
                                             ShadowRays<N>& shadow) {
    const float clamp = bounce > 0 ? settings.clamp : 0.0f;  // radiance; times the path's weight it is irradiance
    const int count = path.count, slots = whole_vectors<N>(count);
    REALCAM_LANES
    for (int i = 0; i < slots; ++i) {
        const RaySpawnPoint spawn = surfaces[i];
        const Vec3f normal = surfaces.normal[i];
        const LightSample light = lights[i];
        // cos / pi: both the density of BSDF sampling and, times the albedo, the Lambertian BSDF times the cosine.
        const float density = cosine_pdf(normal, light.direction);
        const bool is_front = (i < count) & (dot(spawn.geometric_normal, light.direction) > 0.0f);
        const float weight = is_weighted ? mis_weight(light.pdf, density) : 1.0f;
        const Color contribution = (weight * density) * surfaces.diffuse[i] * path.throughput[i] * light.irradiance;
        shadow.set(i, spawn, light, clamped(select(is_front, contribution, Color{0, 0, 0}), clamp * path.weight[i]));
    }
}

/// Samples the next rays at surfaces with only a Lambertian lobe: scatter_path for all slots, if all_lobes_scatter.
template <int N>
REALCAM_INLINE void scatter_lambert(const PlainSurfaces<N>& surfaces, const PathNumbers<N>& u, PathState<N>& path) {
    const int count = path.count, slots = whole_vectors<N>(count);
    REALCAM_LANES
    for (int i = 0; i < slots; ++i) {
        const RaySpawnPoint spawn = surfaces[i];
        const Vec3f normal = surfaces.normal[i], direction = sample_cosine(normal, u[i]);
        const float density = cosine_pdf(normal, direction);
        const float above = select(density > 0.0f, dot(spawn.geometric_normal, direction), 0.0f);
        const Color throughput = path.throughput[i] * surfaces.diffuse[i];
        path.rays.active[i] = ((above > 0.0f) & (i < count) & !is_black(throughput)) ? 1 : 0;
        path.throughput.set(i, throughput);
        path.rays.origin.set(i, ray_start(spawn, direction));
        path.rays.direction.set(i, direction);
        path.pdf[i] = density;
        path.receiver_position.set(i, spawn.position);
        path.receiver_normal.set(i, normal);
    }
}

/// Returns the BSDF, Lambert and Phong, of the surface in slot i.
template <int N>
REALCAM_INLINE PlainBsdf phong_bsdf(const PlainSurfaces<N>& surfaces, const PathState<N>& path, int i) {
    return {surfaces.normal[i], surfaces.geometric_normal[i], -path.rays.direction[i], surfaces.diffuse[i],
            surfaces.phong[i],  surfaces.shininess[i]};
}

}  // namespace scatter_plain_paths_detail

/// scatter_at for all paths of a block in a plain scene, whose materials have only Lambertian and Phong lobes.
/// Vectorised if all surfaces of the block are Lambertian. `shadow`: receives the shadow rays, one for each light
/// sample.
template <int N>
REALCAM_INLINE void scatter_plain_paths(const SceneView& view, const PathSettings& settings,
                                        const SampleBlock<N>& block, int bounce, const PlainSurfaces<N>& surfaces,
                                        PathState<N>& path, LightRays<N>& shadow) {
    using namespace scatter_plain_paths_detail;
    const std::uint32_t first_dimension = dimension::of_bounce(bounce);
    const auto seed = [&](int i) { return block.bits(path.lane(i), first_dimension); };
    const PathNumbers<N> light_numbers(block, path, first_dimension + dimension::light);
    const bool all_scatter = all_lobes_scatter(settings, bounce);
    const SkySampling sky = sky_sampling(view, all_scatter, bounce == 0);
    const LightKindsLanes<N> kinds(view, sky, surfaces, path.count);
    for (int k = 0; k < kLightSampleCount; ++k) {
        if (!has_light(view, sky, k)) continue;
        LightSamples<N> lights;
        sample_lights<SceneKind::plain>(view, kinds, k, surfaces, path, light_numbers, seed, lights);
        if (surfaces.has_phong) {
            for (int i = 0; i < path.count; ++i)
                set_direct_light(settings, bounce, i, surfaces[i], phong_bsdf(surfaces, path, i), lights[i], path,
                                 shadow[k]);
        } else if (all_scatter) {
            set_direct_light_lambert<true>(settings, bounce, surfaces, lights, path, shadow[k]);
        } else {
            set_direct_light_lambert<false>(settings, bounce, surfaces, lights, path, shadow[k]);
        }
    }
    if (!surfaces.has_phong && !all_scatter) return;
    const PathNumbers<N> u(block, path, first_dimension + dimension::scatter);
    if (!surfaces.has_phong) return scatter_lambert(surfaces, u, path);
    for (int i = 0; i < path.count; ++i) {
        PlainBsdf bsdf = phong_bsdf(surfaces, path, i);
        scatter_path(settings, bounce, i, surfaces[i], {surfaces.position[i], surfaces.normal[i]}, bsdf, u,
                     unit_float(seed(i)), path);
    }
}

}  // namespace REALCAM_NAMESPACE
