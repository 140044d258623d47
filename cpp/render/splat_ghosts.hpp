#pragma once
#include "../camera/ghost_view.hpp"
#include "../math/cdf.hpp"
#include "../scene/light.hpp"
#include "effects.hpp"
#include "met_light.hpp"

namespace REALCAM_NAMESPACE {

// Ghosts and starbursts of lights, forward: from a light through a place in front of the lens, along one ghost's way or
// the lens's own, to wherever on the film it ends. All samples of a block take the same way, so that they run as vector
// code.

/// So many samples in a row take the same way.
inline constexpr std::uint32_t kGhostBlock = 256;

/// Ghost samples, of the whole film together.
struct GhostRange {
    std::uint64_t first_block;
    std::uint32_t seed;
};

namespace splat_ghosts_detail {

namespace ghost_dimension {
inline constexpr std::uint32_t way = 0, light = 1, entry = 2, time = 3, diffraction = 4;
}

/// Share of the samples that enter somewhere about the entry's rectangle, and share of those that enter anywhere: for
/// what the rectangles have missed.
inline constexpr float kAround = 1.0f / 16, kAnywhere = 1.0f / 64, kAroundScale = 3;

/// A place in front of the lens, in the plane across light of one direction.
struct EntryPlace {
    float along, across;  ///< away from the axis, and across that, mm
    float density;  ///< per mm^2
};

REALCAM_INLINE EntryPlace entry_place(const GhostEntry& entry, float reach, Vec2f u) {
    const bool known = entry.half_width > 0.0f;
    const float middle = 0.5f * (entry.low + entry.high), half_length = 0.5f * (entry.high - entry.low);
    const float anywhere = select(known, kAnywhere, 1.0f), around = select(known, kAround, 0.0f);
    const bool is_anywhere = u.x < anywhere, is_around = u.x < anywhere + around;
    const float begin = select(is_anywhere, 0.0f, select(is_around, anywhere, anywhere + around));
    const float share = select(is_anywhere, anywhere, select(is_around, around, 1.0f - anywhere - around));
    const float scale = select(is_around, kAroundScale, 1.0f), fresh = (u.x - begin) / share;
    const float along =
        select(is_anywhere, 0.0f, middle) + (2.0f * fresh - 1.0f) * select(is_anywhere, reach, scale * half_length);
    const float across = (2.0f * u.y - 1.0f) * select(is_anywhere, reach, scale * entry.half_width);
    const auto is_within = [&](float factor) {
        return (std::fabs(along - middle) <= factor * half_length) & (std::fabs(across) <= factor * entry.half_width);
    };
    const float per_area = 1.0f / select(known, 4.0f * half_length * entry.half_width, 1.0f);
    const float density =
        select(known & is_within(1.0f), (1.0f - anywhere - around) * per_area, 0.0f) +
        select(known & is_within(kAroundScale), around * per_area / (kAroundScale * kAroundScale), 0.0f) +
        select((std::fabs(along) <= reach) & (std::fabs(across) <= reach), anywhere / (4.0f * reach * reach), 0.0f);
    return {along, across, density};
}

/// The axes of a lens in the scene.
struct LensFrame {
    CameraPlacement camera;
    float front_vertex_m;

    REALCAM_INLINE Vec3f direction(Vec3f scene) const {
        return {dot(scene, camera.right), dot(scene, camera.up), dot(scene, camera.backward)};
    }
    /// Of a place in mm, relative to the front vertex.
    REALCAM_INLINE Vec3f place_in_scene(Vec3f lens_mm) const {
        return camera.position + (0.001f * lens_mm.x) * camera.right + (0.001f * lens_mm.y) * camera.up +
               (0.001f * lens_mm.z - front_vertex_m) * camera.backward;
    }
};

REALCAM_INLINE LensFrame lens_frame(const CameraView& camera, float time) {
    return {camera_at(camera, time), camera.front_vertex_m};
}

/// A pixel of the film, or -1.
REALCAM_INLINE std::int32_t pixel_at(const CameraView& camera, float x, float y) {
    const float column = 0.5f * static_cast<float>(camera.width) * (1.0f - x / camera.film_half_width);
    const float row = 0.5f * static_cast<float>(camera.height) * (1.0f + y / camera.film_half_height);
    const bool inside = (column >= 0.0f) & (column < static_cast<float>(camera.width)) & (row >= 0.0f) &
                        (row < static_cast<float>(camera.height));
    return inside ? static_cast<std::int32_t>(row) * camera.width + static_cast<std::int32_t>(column) : -1;
}

/// From the begin of the first row's exposure to the end of the last one's.
REALCAM_INLINE float all_times(const CameraView& camera) {
    return camera.exposed_time + camera.row_time * static_cast<float>(camera.height);
}

/// By how much a sample of this time counts on a row of pixels, which sees what falls on it while it is exposed: or, if
/// that is but a moment, until the next row's.
REALCAM_INLINE float exposure_weight(const CameraView& camera, std::int32_t row, float time) {
    if (!(camera.row_time > 0.0f)) return 1.0f;
    const float begin = static_cast<float>(row) * camera.row_time;
    const float window = select(camera.exposed_time > camera.row_time, camera.exposed_time, camera.row_time);
    return time >= begin && time <= begin + window ? all_times(camera) / window : 0.0f;
}

/// Samples on their way from a light to the film.
template <int N>
struct GhostSamples {
    alignas(kLaneAlignment<std::uint32_t, N>) std::uint32_t number[N];
    alignas(kLaneAlignment<float, N>) float place[N], variable[N];  ///< of the wavelength
    alignas(kLaneAlignment<float, N>) float time[N];
    LightPick lights[N];
    Vec3Lanes<float, N> from;  ///< unit, towards the light, as the middle of the lens sees it; in the lens's axes
    LensRays<float, N> rays;  ///< first in front of the lens, then behind it
    alignas(kLaneAlignment<float, N>) float density[N];  ///< of the place where it enters, per mm^2
    alignas(kLaneAlignment<float, N>) float light_density[N];  ///< of its place on the lights, per steradian; kDelta:
                                                               ///< no ray meets it
    ColorLanes<N> color;  ///< irradiance that its pixel would have if all samples were like it
    SceneRays<N> shadow;
};

/// Chooses a light, for the middle of the lens.
template <SceneKind scene_kind, int N>
REALCAM_INLINE void choose_lights(const SceneView& view, const CameraView& camera, std::uint32_t stream,
                                  std::uint32_t first, GhostSamples<N>& samples) {
    Vec2Lanes<float, N> u;
    REALCAM_LANES
    for (int i = 0; i < N; ++i)
        u.set(i, sample_2d(stream, first + static_cast<std::uint32_t>(i), ghost_dimension::light));
    for (int i = 0; i < N; ++i) {
        const LensFrame frame = lens_frame(camera, samples.time[i]);
        const LightReceiver middle{front_vertex(frame.camera, frame.front_vertex_m), {0, 0, 0}, samples.time[i]};
        LightPick& light = samples.lights[i];
        light = pick_light(view, middle, light_kinds(view, middle), u[i], samples.number[i]);
        Vec3f from = {0, 0, 1};  // behind the lens
        samples.light_density[i] = kDelta;
        if (light.probability > 0.0f) {
            const LightSample sample = sample_picked<scene_kind>(view, middle, light);
            from = frame.direction(sample.direction);
            // Of area lights that are seen from the side, kDelta says that there is no light.
            if (light.kind == LightKind::area || light.kind == LightKind::environment)
                samples.light_density[i] = sample.pdf < kDelta ? light.probability * sample.pdf : 0.0f;
        }
        samples.from.set(i, from);
    }
}

/// Chooses a place in front of the lens through which light of that direction may go this way.
template <int N>
REALCAM_INLINE void choose_entries(const GhostView& ghosts, const GhostEntry* entries, std::uint32_t stream,
                                   std::uint32_t first, GhostSamples<N>& samples) {
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        const Vec2f u = sample_2d(stream, first + static_cast<std::uint32_t>(i), ghost_dimension::entry);
        const float x = samples.from.x[i], y = samples.from.y[i], z = samples.from.z[i];
        const float sine = std::sqrt(x * x + y * y), half_tangent = sine / (1.0f - z);  // no number right behind
        const bool seen = (half_tangent < ghosts.largest_half_tangent) & (z < 0.9f);
        const int bin = static_cast<int>(select(seen, half_tangent / ghosts.largest_half_tangent, 0.0f) *
                                         static_cast<float>(kGhostAngles));
        const EntryPlace at = entry_place(entries[select(bin < kGhostAngles, bin, kGhostAngles - 1)], ghosts.reach, u);
        const float inverse = 1.0f / select(sine > 0.0f, sine, 1.0f);
        const float away_x = select(sine > 0.0f, x * inverse, 1.0f), away_y = y * inverse;
        samples.rays.origin.set(i, {-at.along * z * away_x - at.across * away_y,
                                    -at.along * z * away_y + at.across * away_x, at.along * sine});
        samples.rays.direction.set(i, {0, 0, 1});
        samples.rays.status[i] = select(seen, 0, static_cast<int>(RayStatus::vignetted));
        samples.density[i] = at.density;
    }
}

/// Sends the light from where it really comes to that place. `scale`: of the irradiance there, mm^2.
template <SceneKind scene_kind, int N>
REALCAM_INLINE void send_light(const SceneView& view, const CameraView& camera, float scale, GhostSamples<N>& samples) {
    LensRays<float, N>& rays = samples.rays;
    for (int i = 0; i < N; ++i) {
        if (rays.status[i] != 0) continue;
        const LensFrame frame = lens_frame(camera, samples.time[i]);
        const LightReceiver here{frame.place_in_scene(rays.origin[i]), {0, 0, 0}, samples.time[i]};
        const LightSample light = sample_picked<scene_kind>(view, here, samples.lights[i]);
        // A light that is near has another direction here, and the plane is across that in the middle.
        const Vec3f to_light = frame.direction(light.direction);
        const float cosine = dot(to_light, samples.from[i]);
        if (is_black(light.irradiance) || !(cosine > 0.0f)) {
            rays.status[i] = static_cast<int>(RayStatus::vignetted);
            continue;
        }
        const float over = scale * cosine / (samples.density[i] * samples.lights[i].probability);
        samples.color.set(i, bounded_light(over * light.irradiance));
        rays.direction.set(i, -to_light);
        const bool is_near = light.distance < kFarAway;
        samples.shadow.origin.set(i, here.position);
        samples.shadow.direction.set(i, is_near ? light.distance * light.direction : light.direction);
        samples.shadow.far[i] = is_near ? (light.reach > 0.0f ? light.reach : 0.0f) : kFarAway;
    }
}

/// Takes the light through the lens.
template <LensKind lens_kind, bool has_wavelengths, int N>
REALCAM_INLINE void pass_lens(const GhostView& ghosts, const GhostWay& way, GhostSamples<N>& samples,
                              PassedPower<N>& passed) {
    const LensView<float> lens{ghosts.surfaces + way.first, way.count, ghosts.kind, ghosts.iris};
    if constexpr (has_wavelengths) {
        if (ghosts.spectral_coatings)
            trace_lens<lens_kind>(
                lens, samples.rays, NoRecord{},
                GhostMedia<kSpectrumTerms, N>{ghosts.indices + way.first, ghosts.spectral_coatings + way.first,
                                              samples.variable, passed});
        else
            trace_lens<lens_kind>(lens, samples.rays, NoRecord{},
                                  ManyWavelengths{ghosts.indices + way.first, samples.variable});
    } else {
        trace_lens<lens_kind>(
            lens, samples.rays, NoRecord{},
            GhostMedia<kOneWavelengthTerms, N>{nullptr, ghosts.coatings + way.first, nullptr, passed});
    }
}

/// Where light that geometrical optics brings to `film` goes by diffraction, and how much of it. Of lights that rays
/// meet it is what the edges of the aperture diffract, and as much of that as samples of pixels leave to splats
/// (set_first_density); of the others it is all.
template <int N>
REALCAM_INLINE Vec2f diffracted(const CameraView& camera, Vec2f film, Vec2f u, Vec2f v, int lane,
                                GhostSamples<N>& samples) {
    const float nm = wavelength_at(camera.dispersion, samples.place[lane]);
    const bool all = samples.light_density[lane] == kDelta;
    Vec2f kick;
    float weight;
    if (all & ((samples.number[lane] & 1u) != 0)) {
        const DiffractionKick drawn = draw_kick(camera.diffraction, film, u, v);
        kick = drawn.mm_per_nm;
        weight = drawn.from_edge ? 0.0f : 2.0f;
    } else {
        const EdgeKick edge = draw_edge_kick(camera.diffraction, film, nm, u, v);
        kick = edge.mm_per_nm;
        weight = edge.weight * (all ? 2.0f : mis_weight(samples.light_density[lane], camera.diffraction.splat_density));
    }
    samples.color.set(lane, weight * samples.color[lane]);
    return {film.x + nm * kick.x, film.y + nm * kick.y};
}

/// The pixels that the light reaches, or -1, and what it brings there if nothing in the scene is in its way.
template <SceneKind scene_kind, bool has_wavelengths, int N>
REALCAM_INLINE void reach_film(const CameraView& camera, const GhostView& ghosts, std::uint32_t stream,
                               std::uint32_t first, const PassedPower<N>& passed, GhostSamples<N>& samples,
                               std::int32_t (&pixel)[N]) {
    for (int i = 0; i < N; ++i) {
        samples.shadow.active[i] = 0;
        pixel[i] = -1;
        if (samples.rays.status[i] != 0) continue;
        const Vec3f o = samples.rays.origin[i], d = samples.rays.direction[i];
        const float way = (camera.film_distance - o.z) / d.z;
        Vec2f film = {o.x + way * d.x, o.y + way * d.y};
        if constexpr (has_wavelengths) {
            if (ghosts.diffracts) {
                const std::uint32_t sample = first + static_cast<std::uint32_t>(i);
                film = diffracted(camera, film, sample_2d(stream, sample, ghost_dimension::diffraction),
                                  sample_2d(stream, sample, ghost_dimension::diffraction + 1), i, samples);
            }
        }
        pixel[i] = pixel_at(camera, film.x, film.y);
        if (pixel[i] < 0) continue;
        Color c = passed.of_unpolarised(i) * samples.color[i];
        if constexpr (has_wavelengths) {
            constexpr float kAll[kSharedWavelengths] = {1, 1, 1};
            c = film_color(camera.dispersion, samples.place[i], 1, kAll, c);
        }
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

/// Takes N samples of a block, from number `first` in it: splat(pixel, irradiance, dither) for each that lights a
/// pixel. The irradiance is that which the pixel would have if each sample were like this one; `dither`: a random
/// number. `SceneT`: as in advance_paths.
template <LensKind lens_kind, SceneKind scene_kind, bool has_wavelengths, int N, class SceneT, class Splat>
REALCAM_HD inline void splat_ghosts(const SceneView& view, const CameraView& camera, const GhostView& ghosts,
                                    GhostRange range, std::uint32_t first, SceneT&& scene, Splat&& splat) {
    using namespace splat_ghosts_detail;
    // A sequence has 2^32 samples, 2^24 blocks.
    const auto block = static_cast<std::uint32_t>(range.first_block);
    const std::uint32_t round = hash32(range.seed, static_cast<std::uint32_t>(range.first_block >> 24) + 1u);
    const int way_number = find_in_cdf(ghosts.cdf, ghosts.way_count, sample_2d(round, block, ghost_dimension::way).x);
    const GhostWay way = ghosts.ways[way_number];
    const std::uint32_t stream = hash32(static_cast<std::uint32_t>(way_number), round);
    const std::uint32_t first_sample = block * kGhostBlock + first;
    const float pixel_area = 4.0f * camera.film_half_width * camera.film_half_height /
                             (static_cast<float>(camera.width) * static_cast<float>(camera.height));

    GhostSamples<N> samples;
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        const std::uint32_t sample = first_sample + static_cast<std::uint32_t>(i);
        samples.number[i] = hash32(stream, sample);
        samples.time[i] = samples.place[i] = samples.variable[i] = 0;
        if constexpr (scene_kind == SceneKind::any || has_wavelengths) {
            const Vec2f u = sample_2d(stream, sample, ghost_dimension::time);
            if constexpr (scene_kind == SceneKind::any) samples.time[i] = u.x * all_times(camera);
            if constexpr (has_wavelengths) {
                samples.place[i] = u.y * static_cast<float>(camera.dispersion.cell_count);
                samples.variable[i] = camera.dispersion.variable.at(wavelength_at(camera.dispersion, samples.place[i]));
            }
        }
    }
    choose_lights<scene_kind>(view, camera, stream, first_sample, samples);
    choose_entries(ghosts, ghosts.entries + way_number * kGhostAngles, stream, first_sample, samples);
    send_light<scene_kind>(view, camera, 1.0f / (pixel_area * way.probability), samples);
    PassedPower<N> passed;
    pass_lens<lens_kind, has_wavelengths>(ghosts, way, samples, passed);
    alignas(kLaneAlignment<std::int32_t, N>) std::int32_t pixel[N], hidden[N];
    reach_film<scene_kind, has_wavelengths>(camera, ghosts, stream, first_sample, passed, samples, pixel);
    scene.occluded(samples.shadow, hidden);
    for (int i = 0; i < N; ++i)
        if (samples.shadow.active[i] && !hidden[i])
            splat(pixel[i], samples.color[i], unit_float(hash32(samples.number[i])));
}

}  // namespace REALCAM_NAMESPACE
