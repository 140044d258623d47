#pragma once
#include "../../scene/materials/glossy_bsdf.hpp"
#include "light_samples.hpp"
#include "scatter_paths.hpp"
#include "shade_hits.hpp"

namespace REALCAM_NAMESPACE {

/// Surfaces that the paths of a block have hit in a scene that is not plain. Surfaces that GlossyBsdf describes are
/// stored in lanes; others are stored point by point, and their lanes are black.
template <int N>
struct GlossySurfaces {
    Vec3Lanes<float, N> position, geometric_normal, normal;
    ColorLanes<N> base, f0;
    Lanes<float, N> self_offset, f90, metallic, alpha;
    Lanes<std::int32_t, N> is_glossy;
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
    /// Computes the lobes once, because each step down the tree of lights reads them.
    REALCAM_INLINE void find_lobes(const PathState<N>& path) {
        const int slots = whole_vectors<N>(path.count);
        REALCAM_LANES
        for (int i = 0; i < slots; ++i) lobe_share[i] = light_lobe(glossy(i), normal[i], -path.rays.direction[i]).share;
    }
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

/// Lobes of a surface that send out a ray, and the probability of each. The flags are numbers, 1 or 0, because gcc does
/// not vectorise a loop with branches on conditions, even if these are the same for all lanes.
struct GlossySenders {
    float diffuse_sends, specular_sends;

    /// After the last bounce only the specular lobe sends out a ray. With LightTransport::whitted it does not either,
    /// because it is not a mirror.
    REALCAM_INLINE GlossySenders(const PathSettings& settings, int bounce)
        : diffuse_sends(goes_on(settings, bounce) ? 1.0f : 0.0f),
          specular_sends(settings.transport == LightTransport::whitted ? 0.0f : 1.0f) {}

    struct Shares {
        float diffuse, specular;

        REALCAM_INLINE float pdf_of(const GlossyBsdf::Value& v) const {
            return diffuse * v.diffuse_pdf + specular * v.specular_pdf;
        }
    };
    REALCAM_INLINE Shares shares_of(const GlossyBsdf& bsdf) const {
        const float diffuse = diffuse_sends * bsdf.diffuse_albedo(), specular = specular_sends * bsdf.specular_albedo(),
                    albedo = diffuse + specular;
        return {select(albedo > 0.0f, diffuse / albedo, 0.0f), select(albedo > 0.0f, specular / albedo, 0.0f)};
    }
};

/// Light for surfaces that GlossyBsdf describes, as light_path computes it for one path. Others get no light.
template <int N>
REALCAM_INLINE void light_glossy(const PathSettings& settings, int bounce, const GlossySurfaces<N>& surfaces,
                                 const LightSamples<N>& lights, const PathState<N>& path, ShadowRays<N>& shadow) {
    const GlossySenders senders(settings, bounce);
    const float clamp = bounce > 0 ? settings.clamp : 0.0f;
    const int slots = whole_vectors<N>(path.count);
    REALCAM_LANES
    for (int i = 0; i < slots; ++i) {
        const RaySpawnPoint spawn = surfaces[i];
        const GlossyBsdf bsdf(surfaces.glossy(i), surfaces.normal[i], spawn.geometric_normal, -path.rays.direction[i]);
        const LightSample light = lights[i];
        const GlossyBsdf::Value to_light = bsdf.eval(light.direction);
        const float weight = mis_weight(light.pdf, senders.shares_of(bsdf).pdf_of(to_light));
        const float diffuse_weight = senders.diffuse_sends * weight + (1.0f - senders.diffuse_sends);
        const Color scattered = diffuse_weight * to_light.diffuse + weight * to_light.specular;
        const Color seen = scattered * path.throughput[i] * light.irradiance;
        const bool is_used = surfaces.is_glossy[i] != 0;
        shadow.set(i, spawn, light, clamped(select(is_used, seen, Color{0, 0, 0}), clamp * path.weight[i]));
    }
}

/// Next rays for these surfaces, as scatter_path computes them for one path. Others keep their paths.
template <SceneKind scene_kind, int N>
REALCAM_INLINE void scatter_glossy(const PathSettings& settings, int bounce, SkySampling sky,
                                   const GlossySurfaces<N>& surfaces, const PathNumbers<N>& u, PathState<N>& path) {
    const GlossySenders senders(settings, bounce);
    const int slots = whole_vectors<N>(path.count);
    REALCAM_LANES
    for (int i = 0; i < slots; ++i) {
        const RaySpawnPoint spawn = surfaces[i];
        const Vec3f normal = surfaces.normal[i], arriving = path.rays.direction[i];
        const GlossyBsdf bsdf(surfaces.glossy(i), normal, spawn.geometric_normal, -arriving);
        const GlossySenders::Shares shares = senders.shares_of(bsdf);
        const Color throughput = path.throughput[i];
        const bool is_used = surfaces.is_glossy[i] != 0;
        Vec2f number = u[i];
        const bool is_diffuse = number.x < shares.diffuse;
        number.x = left_over(select(is_diffuse, number.x, number.x - shares.diffuse),
                             select(is_diffuse, shares.diffuse, shares.specular));
        const Vec3f direction = bsdf.sample(is_diffuse, number);
        const GlossyBsdf::Value value = bsdf.eval(direction);
        const float pdf = shares.pdf_of(value);
        // A diffuse lobe that sends out no ray is left out.
        const Color sum = senders.diffuse_sends * value.diffuse + value.specular;
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

/// scatter_paths for many lanes, vectorised for surfaces that GlossyBsdf describes.
template <SceneKind scene_kind, int N>
REALCAM_INLINE void scatter_glossy_paths(const SceneView& view, const PathSettings& settings,
                                         const SampleBlock<N>& block, int bounce, GlossySurfaces<N>& surfaces,
                                         PathState<N>& path, LightRays<N>& shadow, std::int32_t (&darkens)[N]) {
    using namespace scatter_glossy_paths_detail;
    const std::uint32_t first_dimension = dimension::of_bounce(bounce);
    const PathNumbers<N> light_numbers(block, path, first_dimension + dimension::light),
        scatter_numbers(block, path, first_dimension + dimension::scatter);
    const auto seed = [&](int i) { return block.bits(path.lane(i), first_dimension); };
    // Unused lanes of the last vector are looked up in tables, too, and must hold valid numbers.
    for (int i = path.count; i < whole_vectors<N>(path.count); ++i) {
        surfaces.copy(0, i);
        path.rays.direction.set(i, path.rays.direction[0]);
    }
    surfaces.find_lobes(path);
    const SkySampling sky = sky_sampling(view, goes_on(settings, bounce), bounce == 0);
    const LightKindsLanes<N> kinds(view, sky, surfaces, path.count);
    for (int k = 0; k < kLightSampleCount; ++k) {
        if (!has_light(view, sky, k)) continue;
        LightSamples<N> lights;
        sample_lights<scene_kind>(view, kinds, k, surfaces, path, light_numbers, seed, lights);
        light_glossy(settings, bounce, surfaces, lights, path, shadow[k]);
    }
    scatter_glossy<scene_kind>(settings, bounce, sky, surfaces, scatter_numbers, path);
    for (int i = 0; i < path.count; ++i) {
        darkens[i] = 0;
        if (!surfaces.is_glossy[i])
            darkens[i] = scatter_at<scene_kind>(view, settings, bounce, i, surfaces.others.points[i], light_numbers,
                                                scatter_numbers, seed(i), path, shadow);
    }
}

}  // namespace REALCAM_NAMESPACE
