#pragma once
#include "light_samples.hpp"
#include "scatter_paths.hpp"

namespace REALCAM_NAMESPACE {

namespace scatter_plain_paths_detail {

/// Light for Lambert's lobe, as scatter_path finds it for one path. `goes_on`: at compile time, because gcc makes no
/// vector code of a loop that asks for it.
template <bool goes_on, int N>
REALCAM_INLINE void light_lambert(const PathSettings& settings, int bounce, const PlainSurfaces<N>& surfaces,
                                  const LightSamples<N>& lights, const PathState<N>& path, ShadowRays<N>& shadow) {
    const float clamp = bounce > 0 ? settings.clamp : 0.0f;
    const int count = path.count, places = whole_vectors<N>(count);
    REALCAM_LANES
    for (int i = 0; i < places; ++i) {
        const SurfacePlace place = surfaces[i];
        const Vec3f normal = surfaces.normal[i];
        const LightSample light = lights[i];
        const float density = cosine_pdf(normal, light.direction);
        const bool is_seen = (i < count) & (dot(place.geometric_normal, light.direction) > 0.0f);
        const float weight = goes_on ? mis_weight(light.pdf, density) : 1.0f;
        const Color seen = (weight * density) * surfaces.diffuse[i] * path.throughput[i] * light.irradiance;
        shadow.set(i, place, light, clamped(select(is_seen, seen, Color{0, 0, 0}), clamp * path.weight[i]));
    }
}

/// The next ray for Lambert's lobe, likewise.
template <int N>
REALCAM_INLINE void scatter_lambert(const PlainSurfaces<N>& surfaces, const PathNumbers<N>& u, PathState<N>& path) {
    const int count = path.count, places = whole_vectors<N>(count);
    REALCAM_LANES
    for (int i = 0; i < places; ++i) {
        const SurfacePlace place = surfaces[i];
        const Vec3f normal = surfaces.normal[i], direction = sample_cosine(normal, u[i]);
        const float density = cosine_pdf(normal, direction);
        const float above = select(density > 0.0f, dot(place.geometric_normal, direction), 0.0f);
        const Color throughput = path.throughput[i] * surfaces.diffuse[i];
        path.rays.active[i] = ((above > 0.0f) & (i < count) & !is_black(throughput)) ? 1 : 0;
        path.throughput.set(i, throughput);
        path.rays.origin.set(i, ray_start(place, direction));
        path.rays.direction.set(i, direction);
        path.pdf[i] = density;
        path.receiver_position.set(i, place.position);
        path.receiver_normal.set(i, normal);
    }
}

}  // namespace scatter_plain_paths_detail

/// scatter_paths for a plain scene and many lanes: Lambert's lobe, which most surfaces have alone, as vector code.
template <int N>
REALCAM_INLINE void scatter_plain_paths(const SceneView& view, const PathSettings& settings,
                                        const SampleBlock<N>& block, int bounce, const PlainSurfaces<N>& surfaces,
                                        PathState<N>& path, ShadowRays<N>& shadow) {
    using namespace scatter_plain_paths_detail;
    const std::uint32_t first_dimension = dimension::of_bounce(bounce);
    const auto seed = [&](int i) { return block.bits(path.lane(i), first_dimension); };
    LightSamples<N> lights;
    sample_lights<SceneKind::plain>(view, surfaces, path,
                                    PathNumbers<N>(block, path, first_dimension + dimension::light), seed, lights);
    const bool goes_on = bounce < settings.max_bounces && settings.transport == LightTransport::paths;
    if (!surfaces.has_phong && !goes_on) return light_lambert<false>(settings, bounce, surfaces, lights, path, shadow);
    const PathNumbers<N> u(block, path, first_dimension + dimension::scatter);
    if (!surfaces.has_phong) {
        light_lambert<true>(settings, bounce, surfaces, lights, path, shadow);
        return scatter_lambert(surfaces, u, path);
    }
    for (int i = 0; i < path.count; ++i) {
        PlainBsdf bsdf{surfaces.normal[i], surfaces.geometric_normal[i], -path.rays.direction[i], surfaces.diffuse[i],
                       surfaces.phong[i],  surfaces.shininess[i]};
        scatter_path(settings, bounce, i, surfaces[i], {surfaces.position[i], surfaces.normal[i]}, bsdf, lights[i], u,
                     unit_float(seed(i)), path, shadow);
    }
}

}  // namespace REALCAM_NAMESPACE
