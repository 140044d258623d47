#pragma once
#include "../../camera/models/generate_rays.hpp"
#include "../../scene/lights/attenuation.hpp"
#include "../../scene/lights/light.hpp"
#include "../path/emitter_hit.hpp"
#include "ghost_lens_paths.hpp"

namespace REALCAM_NAMESPACE {

// Ghosts and starbursts of lights, by light tracing: from a light through a point in front of the lens, along one ghost
// path (two reflections in the lens) or the direct path, to the film point that it reaches.

namespace splat_ghosts_detail {

/// Indices of the pairs of random numbers of a sample, by their use. Pair 0 chooses the ghost path.
namespace ghost_dimension {
inline constexpr std::uint32_t light = 1, entry = 2, time = 3, diffraction = 4;
}

/// Converts a point of the lens, in mm relative to its front vertex, to render space. `lens`: the camera's frame, or
/// its LensPlacement. Lens coordinates: see ARCHITECTURE.md.
REALCAM_INLINE Vec3f point_in_scene(const CameraFrame& lens, float front_vertex_m, Vec3f lens_mm) {
    return lens.position + (0.001f * lens_mm.x) * lens.right + (0.001f * lens_mm.y) * lens.up +
           (0.001f * lens_mm.z - front_vertex_m) * lens.backward;
}

/// Vector in render space from the centre of projection towards a light that was sampled at `receiver`.
REALCAM_INLINE Vec3f towards_light(const CameraView& camera, const CameraFrame& frame, Vec3f receiver,
                                   const LightSample& light) {
    if (!(light.distance < kFarAway)) return light.direction;
    return receiver + light.distance * light.direction - centre_of_projection(camera, frame);
}

/// Pixel for which a sample's light counts, and the factor of that light.
struct PixelChoice {
    std::int32_t index;  ///< -1: none
    float weight;
};

/// Returns the pixel at a film point, mm. With a filter other than the box, several pixels have a part of the light:
/// one of them is chosen with a probability that is proportional to its part. `number`: random bits of the sample.
REALCAM_INLINE PixelChoice choose_pixel(const CameraView& camera, Vec2f at, std::uint32_t number) {
    const float column =
        0.5f * static_cast<float>(camera.width) * (1.0f - (at.x - camera.film_centre.x) / camera.film_half_width);
    const float row =
        0.5f * static_cast<float>(camera.height) * (1.0f + (at.y - camera.film_centre.y) / camera.film_half_height);
    const float margin = filter_radius(camera.filter) - 0.5f;
    const bool inside = (column >= -margin) & (column < static_cast<float>(camera.width) + margin) & (row >= -margin) &
                        (row < static_cast<float>(camera.height) + margin);
    if (!inside) return {-1, 0.0f};
    if (camera.filter == PixelFilter::box)
        return {static_cast<std::int32_t>(row) * camera.width + static_cast<std::int32_t>(column), 1.0f};
    constexpr std::uint32_t kColumnSalt = 0x636f6c75u, kRowSalt = 0x726f7773u;
    const FilterChoice x = choose_by_filter(camera.filter, column, unit_float(hash32(number, kColumnSalt))),
                       y = choose_by_filter(camera.filter, row, unit_float(hash32(number, kRowSalt)));
    const bool on_film = (x.index >= 0) & (x.index < camera.width) & (y.index >= 0) & (y.index < camera.height);
    return {on_film ? y.index * camera.width + x.index : -1, x.weight * y.weight};
}

/// Returns the time from the beginning of the first row's exposure to a time after which no row counts samples (see
/// exposure_weight), in the unit of CameraView::exposed_time. Samples from lights are distributed uniformly over it.
REALCAM_INLINE float all_times(const CameraView& camera) {
    return camera.exposed_time + camera.row_time * static_cast<float>(camera.height);
}

/// Returns the weight with which a sample at a time counts in a row of pixels, for times that are distributed uniformly
/// over all_times: 0 outside the row's exposure, or, if that is shorter, outside the time until the next row begins.
REALCAM_INLINE float exposure_weight(const CameraView& camera, std::int32_t row, float time) {
    if (!(camera.row_time > 0.0f)) return 1.0f;
    const float begin = static_cast<float>(row) * camera.row_time;
    const float window = select(camera.exposed_time > camera.row_time, camera.exposed_time, camera.row_time);
    return time >= begin && time <= begin + window ? all_times(camera) / window : 0.0f;
}

/// State of N samples that are traced from lights to the film.
template <int N>
struct GhostSamples {
    Lanes<std::uint32_t, N> number;  ///< random bits of the sample
    Lanes<float, N> cell_position;  ///< position of its wavelength among the wavelength cells (DispersionView)
    Lanes<float, N> variable;  ///< dispersion variable of that wavelength (WavelengthVariable)
    Lanes<float, N> time;  ///< fraction of the exposure
    LightPick lights[N];
    Vec3Lanes<float, N> towards;  ///< see placement_towards
    Vec2Lanes<float, N> chief_film;  ///< film point of the light's chief ray (LensPlacement), mm
    Vec3Lanes<float, N> from;  ///< unit, towards the light from the front vertex, in the lens's axes
    LensRays<float, N> rays;  ///< in the lens frame, mm: in front of the lens, then (after the trace) behind it
    Lanes<float, N> density;  ///< density of the entry point, per mm^2
    Lanes<float, N> light_density;  ///< density of the point on the lights, seen from the front vertex, per steradian;
                                    ///< kDelta if no ray hits the light
    ColorLanes<N> color;  ///< flux into the lens, then (after reach_film) the irradiance of the sample's pixel if all
                          ///< samples were equal to this one
    SceneRays<N> shadow;
};

/// Sets the shadow ray from a point to the light that was sampled there.
template <int N>
REALCAM_INLINE void set_shadow_ray(Vec3f from, const LightSample& light, int lane, GhostSamples<N>& samples) {
    const bool is_finite = light.distance < kFarAway;  // see ShadowRays::set in scatter_paths.hpp
    samples.shadow.origin.set(lane, from);
    samples.shadow.direction.set(lane, is_finite ? light.distance * light.direction : light.direction);
    samples.shadow.far[lane] = is_finite ? (light.reach > 0.0f ? light.reach : 0.0f) : kFarAway;
}

/// Chooses a light for each sample by its illuminance at the front vertex. `stream`: of random numbers; `first`: index
/// of the first sample.
template <SceneKind scene_kind, int N>
REALCAM_INLINE void choose_lights(const SceneView& view, const CameraView& camera, std::uint32_t stream,
                                  std::uint32_t first, GhostSamples<N>& samples) {
    Vec2Lanes<float, N> u;
    REALCAM_LANES
    for (int i = 0; i < N; ++i)
        u.set(i, sample_2d(stream, first + static_cast<std::uint32_t>(i), ghost_dimension::light));
    for (int i = 0; i < N; ++i) {
        const CameraFrame frame = camera_at(camera, samples.time[i]);
        const LightReceiver middle{front_vertex(frame, camera.front_vertex_m), {0, 0, 0}, samples.time[i]};
        LightPick& light = samples.lights[i];
        light = pick_light(view, middle, light_kinds(view, SkySampling::chosen, middle), 0, u[i], samples.number[i]);
        Vec3f from = {0, 0, 1}, towards = from;  // behind the lens
        Vec2f chief_film = {0, 0};
        samples.light_density[i] = kDelta;
        if (light.probability > 0.0f) {
            const LightSample sample = sample_picked<scene_kind>(view, middle, light);
            towards = towards_light(camera, frame, middle.position, sample);
            const LensPlacement placement = placement_towards(camera, frame, towards);
            chief_film = placement.film;
            from = to_camera_axes(placement, sample.direction);
            // An area light seen edge-on has the density kDelta and emits no light to the lens.
            if (light.kind == LightKind::area || light.kind == LightKind::environment)
                samples.light_density[i] = sample.pdf < kDelta ? light.probability * sample.pdf : 0.0f;
        }
        samples.towards.set(i, towards);
        samples.chief_film.set(i, chief_film);
        samples.from.set(i, from);
    }
}

/// Largest z of a direction to a light that is traced; z points backward, and light from nearly behind cannot enter.
inline constexpr float kMaxLightZ = 0.9f;

/// Point in front of the lens through which light from a direction may enter and follow a ghost path.
struct LightEntry {
    Vec3f origin;  ///< in the lens frame relative to the front vertex, mm; in the plane perpendicular to the light
    float density;  ///< density with which the point was sampled, per mm^2
    bool can_pass;  ///< false if no light from that direction can follow the path
};

// Samples an entry point for a ghost path. `entries`: the entrance-pupil bounds of the path; `from`: unit vector
// towards the light in the lens's axes; `u`: random numbers in [0, 1).

/// For rotationally symmetric lenses: the bounds depend on the angle to the axis alone.
REALCAM_INLINE LightEntry rotational_light_entry(const GhostView& ghosts, const GhostBounds* entries, Vec3f from,
                                                 Vec2f u) {
    const auto [x, y, z] = from;
    const float sine = std::sqrt(x * x + y * y), half_tangent = sine / (1.0f - z);  // NaN directly behind the lens
    const bool can_pass = (half_tangent < ghosts.largest_half_tangent) & (z < kMaxLightZ);
    const int bin = static_cast<int>(select(can_pass, half_tangent / ghosts.largest_half_tangent, 0.0f) *
                                     static_cast<float>(kGhostBins));
    const EntryPoint point = entry_point(entries[select(bin < kGhostBins, bin, kGhostBins - 1)], ghosts.reach, u);
    const float inverse = 1.0f / select(sine > 0.0f, sine, 1.0f);
    const float away_x = select(sine > 0.0f, x * inverse, 1.0f), away_y = y * inverse;
    return {{-point.along * z * away_x - point.across * away_y, -point.along * z * away_y + point.across * away_x,
             point.along * sine},
            point.density,
            can_pass};
}

/// For lenses without rotational symmetry.
REALCAM_INLINE LightEntry freeform_light_entry(const GhostView& ghosts, const GhostBounds* entries, Vec3f from,
                                               Vec2f u) {
    const bool is_ahead = from.z < kMaxLightZ;
    const Vec3f light = select(is_ahead, from, Vec3f{0, 0, -1});
    const int cell = ghosts.grid.cell_of(half_tangents(light));
    const EntryPoint point = entry_point(entries[select(cell < 0, 0, cell)], ghosts.reach, u);
    const LightAxes axes = light_axes(light);
    return {point.along * axes.x + point.across * axes.y, point.density, is_ahead && cell >= 0};
}

/// `path`: index of the ghost path.
template <LensKind lens_kind>
REALCAM_INLINE LightEntry light_entry(const GhostView& ghosts, int path, Vec3f from, Vec2f u) {
    if constexpr (lens_kind == LensKind::any)
        return freeform_light_entry(ghosts, ghosts.entries + path * kGhostCells, from, u);
    else
        return rotational_light_entry(ghosts, ghosts.entries + path * kGhostBins, from, u);
}

/// Samples the entry point of each sample's light. Samples without one are marked as vignetted.
template <LensKind lens_kind, int N>
REALCAM_INLINE void choose_entries(const GhostView& ghosts, const GhostBlock& block, std::uint32_t first,
                                   GhostSamples<N>& samples) {
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        const Vec2f u = sample_2d(block.stream, first + static_cast<std::uint32_t>(i), ghost_dimension::entry);
        const LightEntry entry = light_entry<lens_kind>(ghosts, block.path_index, samples.from[i], u);
        samples.rays.origin.set(i, entry.origin);
        samples.rays.direction.set(i, {0, 0, 1});
        samples.rays.status[i] = select(entry.can_pass, 0, static_cast<int>(RayStatus::vignetted));
        samples.density[i] = entry.density;
    }
}

/// Samples each chosen light from its entry point, and sets flux, ray into the lens and shadow ray. `scale`: factor of
/// the flux.
template <SceneKind scene_kind, int N>
REALCAM_INLINE void start_at_lights(const SceneView& view, const CameraView& camera, float scale,
                                    GhostSamples<N>& samples) {
    LensRays<float, N>& rays = samples.rays;
    for (int i = 0; i < N; ++i) {
        if (rays.status[i] != 0) continue;
        const LensPlacement lens = placement_towards(camera, camera_at(camera, samples.time[i]), samples.towards[i]);
        const LightReceiver receiver{
            point_in_scene(lens, camera.front_vertex_m, rays.origin[i]), {0, 0, 0}, samples.time[i]};
        LightSample light = sample_picked<scene_kind>(view, receiver, samples.lights[i]);
        attenuate<scene_kind>(view.air, receiver.position, light);
        // A near light has another direction here than at the front vertex, and the entry plane is perpendicular to the
        // latter.
        const Vec3f to_light = to_camera_axes(lens, light.direction);
        const float cosine = dot(to_light, samples.from[i]);
        if (is_black(light.irradiance) || !(cosine > 0.0f)) {
            rays.status[i] = static_cast<int>(RayStatus::vignetted);
            continue;
        }
        const float weight = scale * cosine / (samples.density[i] * samples.lights[i].probability);
        samples.color.set(i, bounded_light(weight * light.irradiance));
        rays.direction.set(i, -to_light);
        set_shadow_ray(receiver.position, light, i, samples);
    }
}

/// Deflects light that geometrical optics would bring to the point `film` (mm) by diffraction at the aperture; returns
/// the new film point and weights the sample's light. For GhostLight::starbursts the deflection is one of those by the
/// aperture's edges; for lights that camera rays can hit, the light has a MIS weight against these (set_first_density).
/// GhostLight::direct gets all other light. `u`, `v`: random numbers.
template <int N>
REALCAM_INLINE Vec2f diffracted(const CameraView& camera, GhostLight light, Vec2f film, Vec2f u, Vec2f v, int lane,
                                GhostSamples<N>& samples) {
    const float nm = wavelength_at(camera.dispersion, samples.cell_position[lane]);
    Vec2f kick;
    float weight = 1.0f;
    if (light == GhostLight::direct) {
        const DiffractionKick drawn = draw_kick(camera.diffraction, film, u, v);
        kick = drawn.mm_per_nm;
        weight = drawn.from_edge ? 0.0f : 1.0f;
    } else {
        const EdgeKick edge = draw_edge_kick(camera.diffraction, film, nm, u, v);
        kick = edge.mm_per_nm;
        weight = edge.weight;
        if (samples.light_density[lane] < kDelta)
            weight *= mis_weight(samples.light_density[lane], camera.diffraction.splat_density);
    }
    samples.color.set(lane, weight * samples.color[lane]);
    return {film.x + nm * kick.x, film.y + nm * kick.y};
}

/// Finds the pixel that each sample's light reaches, or -1, and its irradiance there if nothing in the scene occludes
/// the light; activates the shadow rays of these samples. `passed`: fraction of the power that passes the lens.
template <LensKind lens_kind, SceneKind scene_kind, bool has_wavelengths, int N>
REALCAM_INLINE void reach_film(const CameraView& camera, const GhostView& ghosts, std::uint32_t stream,
                               std::uint32_t first, const PassedPower<N>& passed, GhostSamples<N>& samples,
                               std::int32_t (&pixel)[N]) {
    for (int i = 0; i < N; ++i) {
        samples.shadow.active[i] = 0;
        pixel[i] = -1;
        if (samples.rays.status[i] != 0) continue;
        Vec2f film = landing_on_film<lens_kind>(camera, samples.rays.origin[i], samples.rays.direction[i]);
        float irradiance = irradiance_of_flux<lens_kind>(camera, film);
        if (camera.bundles.nodes && ghosts.light != GhostLight::of_lights) {
            const PictureLanding landing = picture_landing(camera.bundles, samples.chief_film[i], film);
            film = landing.film;
            irradiance *=
                is_defined(camera.bundles, film) ? landing.area * bundle_motion(camera.bundles, film).gain() : 0;
        }
        if constexpr (has_wavelengths) {
            if (ghosts.light != GhostLight::of_lights && camera.effects.diffraction) {
                const std::uint32_t sample = first + static_cast<std::uint32_t>(i);
                film = diffracted(camera, ghosts.light, film, sample_2d(stream, sample, ghost_dimension::diffraction),
                                  sample_2d(stream, sample, ghost_dimension::diffraction + 1), i, samples);
            }
        }
        const PixelChoice chosen = choose_pixel(camera, film, samples.number[i]);
        pixel[i] = chosen.index;
        if (pixel[i] < 0) continue;
        Color c = (chosen.weight * irradiance * passed.of_unpolarised(i)) * samples.color[i];
        if constexpr (has_wavelengths) c = film_color(camera.dispersion, samples.cell_position[i], c);
        if constexpr (scene_kind == SceneKind::any) {
            c = exposure_weight(camera, pixel[i] / camera.width, samples.time[i]) * c;
            samples.shadow.number[i] = shadow_ray_number(samples.number[i]);
            samples.shadow.time[i] = samples.time[i];
        }
        samples.color.set(i, c);
        samples.shadow.active[i] = is_black(c) ? 0 : 1;
    }
}

}  // namespace splat_ghosts_detail

/// Traces N samples of a block from lights to the film, and calls splat(pixel, irradiance, dither) for each that
/// reaches a pixel: `irradiance`, lux, of the pixel if all samples were equal to this one; `dither`: random number in
/// [0, 1) for rounding. `range`: selects the block; `first`: index of the first sample in it. `scene`: as in
/// advance_paths.
template <LensKind lens_kind, SceneKind scene_kind, bool has_wavelengths, int N, class SceneT, class Splat>
REALCAM_HD inline void splat_ghosts(const SceneView& view, const CameraView& camera, const GhostView& ghosts,
                                    GhostRange range, std::uint32_t first, SceneT&& scene, Splat&& splat) {
    using namespace splat_ghosts_detail;
    const GhostBlock block = ghost_block(ghosts, range);
    const std::uint32_t stream = block.stream, first_sample = block.first_sample + first;
    GhostSamples<N> samples;
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        const std::uint32_t sample = first_sample + static_cast<std::uint32_t>(i);
        samples.number[i] = hash32(stream, sample);
        samples.time[i] = samples.cell_position[i] = samples.variable[i] = 0;
        if constexpr (scene_kind == SceneKind::any || has_wavelengths) {
            const Vec2f u = sample_2d(stream, sample, ghost_dimension::time);
            if constexpr (scene_kind == SceneKind::any) samples.time[i] = u.x * all_times(camera);
            if constexpr (has_wavelengths) {
                samples.cell_position[i] = u.y * static_cast<float>(camera.dispersion.cell_count);
                samples.variable[i] =
                    camera.dispersion.variable.at(wavelength_at(camera.dispersion, samples.cell_position[i]));
            }
        }
    }
    choose_lights<scene_kind>(view, camera, stream, first_sample, samples);
    choose_entries<lens_kind>(ghosts, block, first_sample, samples);
    start_at_lights<scene_kind>(view, camera, 1.0f / block.path.probability, samples);
    PassedPower<N> passed;
    pass_ghost_lens_path<lens_kind, has_wavelengths>(ghosts, block.path, samples.rays, samples.variable, passed);
    Lanes<std::int32_t, N> pixel, occluded;
    reach_film<lens_kind, scene_kind, has_wavelengths>(camera, ghosts, stream, first_sample, passed, samples, pixel);
    scene.occluded(samples.shadow, occluded);
    for (int i = 0; i < N; ++i)
        if (samples.shadow.active[i] && !occluded[i])
            splat(pixel[i], samples.color[i], unit_float(hash32(samples.number[i])));
}

}  // namespace REALCAM_NAMESPACE
