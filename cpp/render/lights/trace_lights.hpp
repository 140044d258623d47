#pragma once
#include "../ghosts/splat_ghosts.hpp"
#include "../path/emitter_hit.hpp"

namespace REALCAM_NAMESPACE {

// Images of lights by light tracing: from a point on a light through a point at which its light enters the lens, to the
// film point that it reaches. This is efficient for lamps out of focus: such a lamp covers a large disc of the film,
// but light from it passes only a small part of the pupil for each point of the disc. Pixel samples therefore seldom
// hit the lamp, while each sample from the lamp contributes to the disc.

namespace trace_lights_detail {

using splat_ghosts_detail::GhostSamples;

/// Indices of the pairs of random numbers of a sample, by their use.
namespace traced_dimension {
inline constexpr std::uint32_t entry = 0, point = 1, time = 2;
}

/// Point on a light, as seen from one entry point.
struct TracedLightSample {
    LightSample sample;  ///< irradiance at the entry point, divided by the density of the point on the light
    float density_ratio = 0;  ///< light_tracing_density_ratio times the cosine at the entry plane, for the MIS weight;
                              ///< unused unless can_be_hit
    bool can_be_hit = false;  ///< true if pixel samples can hit the light: emissive triangles
};

/// Samples a point on a light. `light_index`: index of `light` in TracedLightsView::lights; `entry`: point at which the
/// light enters the lens, in render space; `time`: fraction of the exposure; `u`: random numbers in [0, 1).
template <SceneKind scene_kind>
REALCAM_INLINE TracedLightSample sample_traced_light(const SceneView& scene, const TracedLightsView& lights,
                                                     std::int32_t light_index, const TracedLight& light, Vec3f entry,
                                                     float time, Vec2f u) {
    if (light.kind == TracedLightKind::sun) {
        const SunLight& sun = scene.suns[light.first];
        return {{-sun.direction, kFarAway, 1.0f, sun.illuminance, kDelta}};
    }
    if (light.kind == TracedLightKind::point) {
        if constexpr (scene_kind == SceneKind::any)
            return {sample_point_light(point_light_at(scene, scene.points[light.first], time), entry)};
        return {sample_point_light(scene.points[light.first], entry)};
    }
    const CdfChoice chosen = choose_from_cdf(lights.cdfs + light.first + light_index, light.count, u.x);
    const std::int32_t area = lights.triangles[light.first + chosen.index];
    const AreaLight triangle = area_light_at<scene_kind>(scene, area, time);
    const LightSample sample = sample_area<scene_kind>(scene, triangle, entry, {chosen.fresh, u.y});
    TracedLightSample traced{sample, 0, true};
    traced.sample.irradiance = (1.0f / chosen.probability) * sample.irradiance;
    // The density per steradian contains the cosine and the distance.
    if (sample.pdf < kDelta)
        traced.density_ratio =
            lights.scale * light.probability * chosen.probability * sample.pdf / light.entries.area();
    return traced;
}

/// Samples light, time, point on the light and entry point of each of N samples, and sets its ray into the lens, flux
/// and shadow ray. `round`: hash of the seed; `first`: index of the first sample. `wavelength`: receives the position
/// of each sample's first wavelength among the wavelength cells.
template <SceneKind scene_kind, bool has_wavelengths, int N>
REALCAM_INLINE void send_traced_light(const SceneView& view, const CameraView& camera, std::uint32_t round,
                                      std::uint32_t first, GhostSamples<N>& samples, Lanes<float, N>& wavelength) {
    const TracedLightsView& lights = camera.traced_lights;
    for (int i = 0; i < N; ++i) {
        const std::uint32_t index = first + static_cast<std::uint32_t>(i);
        // A light with the probability 2^-halvings gets every 2^halvings-th sample, and consecutive samples of its own
        // sequence.
        const std::int32_t light_index = lights.turns[index & static_cast<std::uint32_t>(lights.turn_count - 1)];
        const TracedLight light = lights.lights[light_index];
        const std::uint32_t stream = hash32(static_cast<std::uint32_t>(light_index), round),
                            sample = index >> light.halvings;
        samples.number[i] = hash32(round, index);
        samples.time[i] = samples.cell_position[i] = samples.variable[i] = 0;
        samples.light_density[i] = kDelta;
        if constexpr (scene_kind == SceneKind::any || has_wavelengths) {
            const Vec2f u = sample_joint_2d(stream, sample, traced_dimension::time);
            if constexpr (scene_kind == SceneKind::any) samples.time[i] = u.x * splat_ghosts_detail::all_times(camera);
            if constexpr (has_wavelengths) wavelength[i] = u.y * static_cast<float>(camera.dispersion.cell_count);
        }
        const Vec2f entry_mm = light.entries.at(sample_joint_2d(stream, sample, traced_dimension::entry));
        CameraFrame frame = camera;
        if constexpr (scene_kind == SceneKind::any) frame = camera_at(camera, samples.time[i]);
        const auto sampled_from = [&](Vec3f point) {
            return sample_traced_light<scene_kind>(view, lights, light_index, light, point, samples.time[i],
                                                   sample_joint_2d(stream, sample, traced_dimension::point));
        };
        LensPlacement placement{frame, {0.0f, 0.0f}};
        if (camera.bundles.nodes) {
            const Vec3f front = front_vertex(frame, camera.front_vertex_m);
            placement = placement_towards(
                camera, frame, splat_ghosts_detail::towards_light(camera, frame, front, sampled_from(front).sample));
        }
        samples.chief_film.set(i, placement.film);
        const EntryPlane plane = entry_plane(placement, camera.front_vertex_m, light);
        const Vec3f entry = plane.origin + (0.001f * entry_mm.x) * plane.along + (0.001f * entry_mm.y) * plane.across;
        // The light that the air scatters is left to pixel samples.
        TracedLightSample traced = sampled_from(entry);
        attenuate<scene_kind>(view.air, entry, traced.sample);
        const float cosine = dot(traced.sample.direction, plane.normal);
        samples.rays.status[i] = static_cast<int>(RayStatus::vignetted);
        if (is_black(traced.sample.irradiance) || !(cosine > 0.0f)) continue;
        samples.rays.status[i] = 0;
        // The complement of the weight of pixel samples: unlike mis_weight(r, 1), it is also right if r is infinite.
        const float weight = traced.can_be_hit ? 1.0f - mis_weight(1.0f, traced.density_ratio / cosine) : 1.0f;
        const float scale = weight * cosine * light.entries.area() / light.probability;
        samples.color.set(i, bounded_light(scale * traced.sample.irradiance));
        samples.rays.origin.set(i, to_camera_axes(placement, entry_mm.x * plane.along + entry_mm.y * plane.across));
        samples.rays.direction.set(i, -to_camera_axes(placement, traced.sample.direction));
        splat_ghosts_detail::set_shadow_ray(entry, traced.sample, i, samples);
    }
}

/// Sets the wavelength of step `step` of each sample (shared_cell_position). `first`: position of each sample's first
/// wavelength among the wavelength cells.
template <int N>
REALCAM_INLINE void set_wavelengths(const DispersionView& view, const float (&first)[N], int step,
                                    GhostSamples<N>& samples) {
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        samples.cell_position[i] = shared_cell_position(view, first[i], step);
        samples.variable[i] = view.variable.at(wavelength_at(view, samples.cell_position[i]));
    }
}

}  // namespace trace_lights_detail

/// Traces N samples from the lights to the film, and calls splat(pixel, irradiance, dither) as splat_ghosts does.
/// `direct`: the direct path through the lens, as a GhostView with a single path. All lights take that path, so that
/// each sample of a block may have another light. `range`, `first`, `scene`: as in splat_ghosts.
template <LensKind lens_kind, SceneKind scene_kind, bool has_wavelengths, int N, class SceneT, class Splat>
REALCAM_HD inline void trace_lights(const SceneView& view, const CameraView& camera, const GhostView& direct,
                                    GhostRange range, std::uint32_t first, SceneT&& scene, Splat&& splat) {
    using namespace splat_ghosts_detail;
    using namespace trace_lights_detail;
    const auto block = static_cast<std::uint32_t>(range.first_block);
    const std::uint32_t round = hash32(range.seed, static_cast<std::uint32_t>(range.first_block >> 24) + 1u);
    const std::uint32_t first_sample = block * kGhostBlock + first;
    GhostSamples<N> samples;
    [[maybe_unused]] Lanes<float, N> wavelength;
    send_traced_light<scene_kind, has_wavelengths>(view, camera, round, first_sample, samples, wavelength);
    // All wavelengths of a sample share its light and entry point; from there each takes its own path through the lens.
    constexpr int kMaxSteps = has_wavelengths ? kSharedWavelengths : 1;
    const int steps = has_wavelengths && camera.dispersion.cell_count > 1 ? kMaxSteps : 1;
    const float share = 1.0f / static_cast<float>(steps);
    const LensRays<float, N> entering = samples.rays;
    const ColorLanes<N> sent = samples.color;
    Lanes<std::int32_t, N> pixels[kMaxSteps], reaches_film = {}, occluded{};
    ColorLanes<N> colors[kMaxSteps];
    for (int step = 0; step < steps; ++step) {
        if constexpr (has_wavelengths) set_wavelengths(camera.dispersion, wavelength, step, samples);
        samples.rays = entering;
        samples.color = sent;
        PassedPower<N> passed;
        pass_ghost_lens_path<lens_kind, has_wavelengths>(direct, direct.paths[0], samples.rays, samples.variable,
                                                         passed);
        reach_film<lens_kind, scene_kind, has_wavelengths>(camera, direct, round, first_sample, passed, samples,
                                                           pixels[step]);
        for (int i = 0; i < N; ++i) {
            if (!samples.shadow.active[i]) pixels[step][i] = -1;
            colors[step].set(i, share * samples.color[i]);
            reaches_film[i] |= samples.shadow.active[i];
        }
    }
    for (int i = 0; i < N; ++i) samples.shadow.active[i] = reaches_film[i];
    scene.occluded(samples.shadow, occluded);
    for (int i = 0; i < N; ++i) {
        if (!reaches_film[i] || occluded[i]) continue;
        for (int step = 0; step < steps; ++step)
            if (pixels[step][i] >= 0)
                splat(pixels[step][i], colors[step][i],
                      unit_float(hash32(samples.number[i], static_cast<std::uint32_t>(step))));
    }
}

}  // namespace REALCAM_NAMESPACE
