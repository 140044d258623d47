#pragma once
#include "../scene/make_bsdf.hpp"
#include "meet_surfaces.hpp"
#include "path_numbers.hpp"
#include "shadow_rays.hpp"

namespace REALCAM_NAMESPACE {

/// A path at a surface: the light that a sample of the lights brings there, and where the path goes next. `u`,
/// `chance`: random numbers for that. Returns whether the path goes through the surface.
template <int N, class BsdfT>
REALCAM_INLINE bool scatter_path(const PathSettings& settings, int bounce, int lane, const SurfacePlace& place,
                                 const LightReceiver& receiver, BsdfT& bsdf, const LightSample& light,
                                 const PathNumbers<N>& u, float chance, PathState<N>& path, ShadowRays<N>& shadow) {
    const Color lambert_and_narrow = bsdf.eval(light.direction);
    // After the last bounce, one more ray looks for the light that narrow lobes show.
    const bool goes_on = bounce < settings.max_bounces && settings.transport == LightTransport::paths;
    // Where only narrow lobes send out a ray, Lambert's lobe sees light samples alone.
    Color seen;
    if (goes_on) {
        seen = mis_weight(light.pdf, bsdf.pdf(light.direction)) * lambert_and_narrow;
    } else {
        if (settings.transport == LightTransport::whitted)
            bsdf.keep_mirrors();
        else
            bsdf.keep_narrow_lobes();
        const Color narrow = bsdf.eval(light.direction);
        seen = lambert_and_narrow;
        if (!is_black(narrow)) seen += (mis_weight(light.pdf, bsdf.pdf(light.direction)) - 1.0f) * narrow;
    }
    seen *= path.throughput[lane] * light.irradiance;
    const float limit = bounce > 0 ? settings.clamp * path.weight[lane] : 0.0f;
    shadow.set(lane, place, light, clamped(seen, limit));

    const BsdfSample next = bsdf.sample(u[lane], chance);
    const Color throughput = path.throughput[lane] * next.weight;
    path.throughput.set(lane, throughput);
    path.rays.origin.set(lane, ray_start(place, next.direction));
    path.rays.direction.set(lane, next.direction);
    path.rays.active[lane] = !is_black(throughput);
    path.pdf[lane] = next.pdf;
    path.receiver_position.set(lane, receiver.position);
    path.receiver_normal.set(lane, receiver.normal);
    return next.refracted;
}

namespace scatter_paths_detail {

/// A sample of one of the lights, by the illuminance that each would bring if nothing stood in between. It is one of
/// eight that sample_light draws, chosen by its share of their illuminance (resampling, Talbot et al. 2005). Where all
/// of those are behind the surface, up to 64 are drawn. Black: no light.
template <SceneKind scene_kind>
REALCAM_INLINE LightSample light_by_illuminance(const SceneView& scene, LightReceiver receiver, std::uint32_t seed) {
    LightSample chosen{{0, 1, 0}, kFarAway, 1.0f, {0, 0, 0}, kDelta};
    float sum = 0.0f;
    for (int i = 0; i < 8 || (i < 64 && !(sum > 0.0f)); ++i) {
        const auto random = [&] { return unit_float(seed = hash32(seed)); };
        const Vec2f u = {random(), random()};
        const LightSample light = sample_light<scene_kind>(scene, receiver, u, hash32(seed));
        const float cosine = dot(receiver.normal, light.direction);
        const float illuminance = cosine > 0.0f ? cosine * luminance(light.irradiance) : 0.0f;
        sum += illuminance;
        if (random() * sum < illuminance) chosen = light;
    }
    return chosen;
}

}  // namespace scatter_paths_detail

/// Scatters a path at a point. `seed`: of the sample at this bounce. Returns whether the surface shows nothing but
/// shadows.
template <SceneKind scene_kind, int N>
REALCAM_INLINE bool scatter_at(const SceneView& view, const PathSettings& settings, int bounce, int place,
                               const SurfacePoint& point, const PathNumbers<N>& light_numbers,
                               const PathNumbers<N>& scatter_numbers, std::uint32_t seed, PathState<N>& path,
                               ShadowRays<N>& shadow) {
    using namespace scatter_paths_detail;
    const Vec3f direction = path.rays.direction[place];
    const float time = time_of<scene_kind>(path, place);
    if constexpr (scene_kind == SceneKind::any) {
        if (point.material->only_shadows) {
            // What is behind is seen as far as the light here is not hidden. The ray keeps its direction, and so the
            // density of that.
            const LightSample light =
                light_by_illuminance<scene_kind>(view, {point.position, point.normal, time}, seed);
            shadow.set(place, point, light, {0, 0, 0});
            shadow.rays.active[place] = !is_black(light.irradiance);
            path.rays.origin.set(place, ray_start(point, direction));
            path.rays.active[place] = 1;
            return true;
        }
    }
    auto bsdf = make_bsdf<scene_kind>(point, -direction);
    const LightReceiver receiver = {point.position, bsdf.is_opaque() ? point.normal : Vec3f{0, 0, 0}, time};
    const LightSample light = sample_light<scene_kind>(view, receiver, light_numbers[place], seed);
    const bool refracted = scatter_path(settings, bounce, place, point, receiver, bsdf, light, scatter_numbers,
                                        unit_float(seed), path, shadow);
    if constexpr (scene_kind != SceneKind::plain) {
        if (refracted) path.absorption.set(place, point.is_front ? point.material->absorption : Color{0, 0, 0});
    }
    return false;
}

/// Scatters the paths that have met a surface. `darkens`: 1 for those whose surface shows nothing but shadows.
template <SceneKind scene_kind, int N>
REALCAM_INLINE void scatter_paths(const SceneView& view, const PathSettings& settings, const SampleBlock<N>& block,
                                  int bounce, const Surfaces<N>& surfaces, PathState<N>& path, ShadowRays<N>& shadow,
                                  std::int32_t (&darkens)[N]) {
    const std::uint32_t first_dimension = dimension::of_bounce(bounce);
    const PathNumbers<N> light_numbers(block, path, first_dimension + dimension::light),
        scatter_numbers(block, path, first_dimension + dimension::scatter);
    const int places = path.places();
    for (int i = 0; i < places; ++i)
        darkens[i] = scatter_at<scene_kind>(view, settings, bounce, i, surfaces.points[i], light_numbers,
                                            scatter_numbers, block.bits(path.lane(i), first_dimension), path, shadow);
}

}  // namespace REALCAM_NAMESPACE
