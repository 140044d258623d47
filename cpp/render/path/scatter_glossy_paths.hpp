#pragma once
#include "../../scene/materials/glossy_bsdf.hpp"
#include "light_samples.hpp"
#include "scatter_paths.hpp"
#include "shade_hits.hpp"

namespace REALCAM_NAMESPACE {

/// Surfaces that the paths of a block have hit in a scene with glossy materials, one per slot. Surfaces that GlossyBsdf
/// describes (is_glossy) are stored in lanes, in the members named as those of SurfacePoint and GlossySurface. All
/// other surfaces are stored one by one in `others`, and are black in lanes.
template <int N>
struct GlossySurfaces {
    Vec3Lanes<float, N> position, geometric_normal, normal;
    ColorLanes<N> base, f0;
    Lanes<float, N> self_offset, f90, metallic, alpha;
    Lanes<std::int32_t, N> is_glossy;  ///< 1 if the surface is stored in lanes
    Lanes<float, N> lobe_share;  ///< LightLobe::share; set by find_lobes
    Surfaces<N> others;

    REALCAM_INLINE void set(int slot, const SurfacePoint& point) {
        position.set(slot, point.position);
        geometric_normal.set(slot, point.geometric_normal);
        normal.set(slot, point.normal);
        self_offset[slot] = point.self_offset;
        is_glossy[slot] = realcam::is_glossy(point);
        set(slot, is_glossy[slot] ? glossy_surface(point) : GlossySurface{});
        if (!is_glossy[slot]) others.set(slot, point);
    }
    /// See Surfaces::set_scattering_point.
    REALCAM_INLINE void set_scattering_point(int slot, Vec3f at, Vec3f direction) {
        others.set_scattering_point(slot, at, direction);
        position.set(slot, at);
        geometric_normal.set(slot, -direction);
        normal.set(slot, -direction);
        self_offset[slot] = 0.0f;
        is_glossy[slot] = 0;
        set(slot, GlossySurface{});
    }
    /// Fills an unused slot with the values of a slot in use.
    REALCAM_INLINE void copy(int from, int to) {
        position.set(to, position[from]);
        geometric_normal.set(to, geometric_normal[from]);
        normal.set(to, normal[from]);
        self_offset[to] = self_offset[from];
        is_glossy[to] = 0;
        set(to, glossy(from));
    }
    REALCAM_INLINE RaySpawnPoint operator[](int slot) const {
        return {position[slot], geometric_normal[slot], self_offset[slot]};
    }
    REALCAM_INLINE GlossySurface glossy(int slot) const {
        return {base[slot], f0[slot], f90[slot], metallic[slot], alpha[slot]};
    }
    /// Computes lobe_share once, because each step down the light tree reads it.
    REALCAM_INLINE void find_lobes(const PathState<N>& path) {
        const int slots = whole_vectors<N>(path.count);
        REALCAM_LANES
        for (int i = 0; i < slots; ++i) lobe_share[i] = light_lobe(glossy(i), normal[i], -path.rays.direction[i]).share;
    }
    /// Returns the lobe by which lights are chosen; `to_eye`: unit vector against the arriving ray.
    REALCAM_INLINE LightLobe lobe(int slot, Vec3f to_eye) const { return {to_eye, alpha[slot], lobe_share[slot]}; }
    REALCAM_INLINE bool is_in_lanes(int slot) const { return is_glossy[slot] != 0; }

private:
    REALCAM_INLINE void set(int slot, const GlossySurface& surface) {
        base.set(slot, surface.base);
        f0.set(slot, surface.f0);
        f90[slot] = surface.f90;
        metallic[slot] = surface.metallic;
        alpha[slot] = surface.alpha;
    }
};

namespace scatter_glossy_paths_detail {

/// Lobes that are sampled for the next ray, and the probability of each. The flags are numbers, 1 or 0, because gcc
/// does not vectorise a loop with branches on conditions, even if these are the same for all lanes.
struct SampledLobes {
    float samples_diffuse, samples_specular;

    /// After the last bounce only the specular lobe is sampled. With LightTransport::whitted it is not sampled either,
    /// because it is not a mirror.
    REALCAM_INLINE SampledLobes(const PathSettings& settings, int bounce)
        : samples_diffuse(all_lobes_scatter(settings, bounce) ? 1.0f : 0.0f),
          samples_specular(settings.transport == LightTransport::whitted ? 0.0f : 1.0f) {}

    struct Probabilities {
        float diffuse, specular;

        /// Density of a direction, per steradian, whose values of the two lobes are `v`.
        REALCAM_INLINE float pdf_of(const GlossyBsdf::Value& v) const {
            return diffuse * v.diffuse_pdf + specular * v.specular_pdf;
        }
    };
    REALCAM_INLINE Probabilities probabilities_of(const GlossyBsdf& bsdf) const {
        const float diffuse = samples_diffuse * bsdf.diffuse_albedo(),
                    specular = samples_specular * bsdf.specular_albedo(), albedo = diffuse + specular;
        return {select(albedo > 0.0f, diffuse / albedo, 0.0f), select(albedo > 0.0f, specular / albedo, 0.0f)};
    }
};

/// attenuate_light for all slots.
template <int N>
REALCAM_INLINE void attenuate_lights(const SceneView& view, const GlossySurfaces<N>& surfaces, const PathState<N>& path,
                                     LightSamples<N>& lights) {
    for (int i = 0; i < path.count; ++i) {
        LightSample light = lights[i];
        attenuate_light<SceneKind::any>(view, surfaces[i], nullptr, path, i, light);
        lights.irradiance.set(i, light.irradiance);
    }
}

/// Direct light for surfaces that GlossyBsdf describes: set_direct_light for all slots. Other surfaces get black
/// contributions.
template <int N>
REALCAM_INLINE void set_direct_light_glossy(const PathSettings& settings, int bounce, const GlossySurfaces<N>& surfaces,
                                            const LightSamples<N>& lights, const PathState<N>& path,
                                            ShadowRays<N>& shadow) {
    const SampledLobes sampled_lobes(settings, bounce);
    const float clamp = bounce > 0 ? settings.clamp : 0.0f;
    const int slots = whole_vectors<N>(path.count);
    REALCAM_LANES
    for (int i = 0; i < slots; ++i) {
        const RaySpawnPoint spawn = surfaces[i];
        const GlossyBsdf bsdf(surfaces.glossy(i), surfaces.normal[i], spawn.geometric_normal, -path.rays.direction[i]);
        const LightSample light = lights[i];
        const GlossyBsdf::Value to_light = bsdf.eval(light.direction);
        const float weight = mis_weight(light.pdf, sampled_lobes.probabilities_of(bsdf).pdf_of(to_light));
        // A lobe that is not sampled receives light from light samples alone, with a weight of 1.
        const float diffuse_weight = sampled_lobes.samples_diffuse * weight + (1.0f - sampled_lobes.samples_diffuse);
        const Color scattered = diffuse_weight * to_light.diffuse + weight * to_light.specular;
        const Color contribution = scattered * path.throughput[i] * light.irradiance;
        const bool is_used = surfaces.is_glossy[i] != 0;
        shadow.set(i, spawn, light, clamped(select(is_used, contribution, Color{0, 0, 0}), clamp * path.weight[i]));
    }
}

/// Samples the next rays at these surfaces: scatter_path for all slots. The paths at other surfaces are unchanged, but
/// inactive until scatter_at continues them.
template <SceneKind scene_kind, int N>
REALCAM_INLINE void scatter_glossy(const PathSettings& settings, int bounce, SkySampling sky,
                                   const GlossySurfaces<N>& surfaces, const PathNumbers<N>& u, PathState<N>& path) {
    const SampledLobes sampled_lobes(settings, bounce);
    const int slots = whole_vectors<N>(path.count);
    REALCAM_LANES
    for (int i = 0; i < slots; ++i) {
        const RaySpawnPoint spawn = surfaces[i];
        const Vec3f normal = surfaces.normal[i], arriving = path.rays.direction[i];
        const GlossyBsdf bsdf(surfaces.glossy(i), normal, spawn.geometric_normal, -arriving);
        const SampledLobes::Probabilities probabilities = sampled_lobes.probabilities_of(bsdf);
        const Color throughput = path.throughput[i];
        const bool is_used = surfaces.is_glossy[i] != 0;
        Vec2f number = u[i];
        const bool is_diffuse = number.x < probabilities.diffuse;
        number.x = remapped_random(select(is_diffuse, number.x, number.x - probabilities.diffuse),
                                   select(is_diffuse, probabilities.diffuse, probabilities.specular));
        const Vec3f direction = bsdf.sample(is_diffuse, number);
        const GlossyBsdf::Value value = bsdf.eval(direction);
        const float pdf = probabilities.pdf_of(value);
        // A diffuse lobe that is not sampled does not count.
        const Color sum = sampled_lobes.samples_diffuse * value.diffuse + value.specular;
        const Color next = select(pdf > 0.0f, (1.0f / pdf) * throughput * sum, Color{0, 0, 0});
        path.rays.active[i] = (is_used & !is_black(next)) ? 1 : 0;
        path.throughput.set(i, select(is_used, next, throughput));
        path.rays.origin.set(i, ray_start(spawn, direction));
        path.rays.direction.set(i, select(is_used, direction, arriving));
        path.pdf[i] = select(is_used, pdf, path.pdf[i]);
        path.set_receiver_lobe(i, select(is_used, surfaces.lobe(i, -arriving), path.receiver_lobe(i)));
        if constexpr (scene_kind == SceneKind::any) path.receiver_sky[i] = select(is_used, sky, path.receiver_sky[i]);
        path.receiver_position.set(i, select(is_used, spawn.position, path.receiver_position[i]));
        path.receiver_normal.set(i, select(is_used, normal, path.receiver_normal[i]));
    }
}

}  // namespace scatter_glossy_paths_detail

/// scatter_at for all paths of a block, vectorised for surfaces that GlossyBsdf describes. `shadow`: receives the
/// shadow rays, one for each light sample. `is_shadow_catcher[i]`: set to 1 if path i ends where its shadow ray is
/// occluded.
template <SceneKind scene_kind, int N>
REALCAM_INLINE void scatter_glossy_paths(const SceneView& view, const PathSettings& settings,
                                         const SampleBlock<N>& block, int bounce, GlossySurfaces<N>& surfaces,
                                         PathState<N>& path, LightRays<N>& shadow,
                                         std::int32_t (&is_shadow_catcher)[N]) {
    using namespace scatter_glossy_paths_detail;
    const std::uint32_t first_dimension = dimension::of_bounce(bounce);
    const PathNumbers<N> light_numbers(block, path, first_dimension + dimension::light),
        scatter_numbers(block, path, first_dimension + dimension::scatter);
    const auto seed = [&](int i) { return block.bits(path.lane(i), first_dimension); };
    // Unused lanes of the last vector are also used as table indices, and must hold valid numbers.
    for (int i = path.count; i < whole_vectors<N>(path.count); ++i) {
        surfaces.copy(0, i);
        path.rays.direction.set(i, path.rays.direction[0]);
    }
    surfaces.find_lobes(path);
    const SkySampling sky = sky_sampling(view, all_lobes_scatter(settings, bounce), bounce == 0);
    const LightKindsLanes<N> kinds(view, sky, surfaces, path.count);
    for (int k = 0; k < kLightSampleCount; ++k) {
        if (!has_light(view, sky, k)) continue;
        LightSamples<N> lights;
        sample_lights<scene_kind>(view, kinds, k, surfaces, path, light_numbers, seed, lights);
        if constexpr (scene_kind == SceneKind::any)
            if (view.has_scattering_media) attenuate_lights(view, surfaces, path, lights);
        set_direct_light_glossy(settings, bounce, surfaces, lights, path, shadow[k]);
    }
    scatter_glossy<scene_kind>(settings, bounce, sky, surfaces, scatter_numbers, path);
    for (int i = 0; i < path.count; ++i) {
        is_shadow_catcher[i] = 0;
        if (!surfaces.is_glossy[i])
            is_shadow_catcher[i] = scatter_at<scene_kind>(view, settings, bounce, i, surfaces.others.points[i],
                                                          light_numbers, scatter_numbers, seed(i), path, shadow);
    }
}

}  // namespace REALCAM_NAMESPACE
