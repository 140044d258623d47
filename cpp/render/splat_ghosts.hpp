#pragma once
#include "../camera/ghost_view.hpp"
#include "../math/cdf.hpp"
#include "../scene/light.hpp"
#include "effects.hpp"
#include "path_state.hpp"

namespace REALCAM_NAMESPACE {

// Ghosts of lights, forward: from a light through a place in front of the lens, along one ghost's way, to wherever on
// the film it ends. All samples of a block take the same way, so that they run as vector code.

/// So many samples in a row take the same way.
inline constexpr std::uint32_t kGhostBlock = 256;

/// Ghost samples, of the whole film together.
struct GhostRange {
    std::uint64_t first_block;
    std::uint32_t seed;
};

namespace splat_ghosts_detail {

namespace ghost_dimension {
inline constexpr std::uint32_t way = 0, light = 1, entry = 2, time = 3;
}

/// Share of the samples that enter somewhere about the entry's rectangle, and share of those that enter anywhere: for
/// what the rectangles have missed.
inline constexpr float kAround = 1.0f / 16, kAnywhere = 1.0f / 64, kAroundScale = 3;

/// A place in front of the lens, in the plane across light of one direction.
struct EntryPlace {
    float along, across;  ///< away from the axis, and across that, mm
    float density;        ///< per mm^2
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

/// What a camera sees of the scene's axes.
struct LensFrame {
    const CameraPlacement camera;
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

/// A pixel of the film, or none.
REALCAM_INLINE std::int32_t pixel_at(const CameraView& camera, float x, float y) {
    const float column = 0.5f * static_cast<float>(camera.width) * (1.0f - x / camera.film_half_width);
    const float row = 0.5f * static_cast<float>(camera.height) * (1.0f + y / camera.film_half_height);
    const bool inside = (column >= 0.0f) & (column < static_cast<float>(camera.width)) & (row >= 0.0f) &
                        (row < static_cast<float>(camera.height));
    return inside ? static_cast<std::int32_t>(row) * camera.width + static_cast<std::int32_t>(column) : -1;
}

}  // namespace splat_ghosts_detail

/// Takes N samples of a block, from number `first` in it: splat(pixel, irradiance, dither) for each that lights a
/// pixel. The irradiance is that which the pixel would have if each sample were like this one; `dither`: a random
/// number. `SceneT`: as in advance_paths.
template <LensKind lens_kind, SceneKind scene_kind, bool disperses, int N, class SceneT, class Splat>
REALCAM_HD inline void splat_ghosts(const SceneView& view, const CameraView& camera, const GhostView& ghosts,
                                    GhostRange range, std::uint32_t first, SceneT&& scene, Splat&& splat) {
    using namespace splat_ghosts_detail;
    constexpr int kTerms = disperses ? kSpectrumTerms : kOneWavelengthTerms;
    const auto block = static_cast<std::uint32_t>(range.first_block);
    const std::uint32_t round = hash32(range.seed, static_cast<std::uint32_t>(range.first_block >> 24) + 1u);
    const int way_number = find_in_cdf(ghosts.cdf, ghosts.way_count, sample_2d(round, block, ghost_dimension::way).x);
    const GhostWay way = ghosts.ways[way_number];
    const std::uint32_t stream = hash32(static_cast<std::uint32_t>(way_number), round);
    const LensView<float> lens{ghosts.surfaces + way.first, way.count, ghosts.kind, ghosts.iris};
    const float pixel_area = 4.0f * camera.film_half_width * camera.film_half_height /
                             (static_cast<float>(camera.width) * static_cast<float>(camera.height));

    const float all_times =
        scene_kind == SceneKind::any ? camera.exposed_time + camera.row_time * static_cast<float>(camera.height) : 0.0f;

    LensRays<float, N> rays;
    SceneRays<N> shadow;
    ColorLanes<N> color;
    Vec3Lanes<float, N> from;  // the light, seen from the middle of the lens
    Vec2Lanes<float, N> light_u, entry_u;
    alignas(kLaneAlignment<float, N>) float place[N], variable[N], time[N], density[N];
    alignas(kLaneAlignment<std::uint32_t, N>) std::uint32_t number[N];
    LightPick picks[N];
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        const std::uint32_t sample = block * kGhostBlock + first + static_cast<std::uint32_t>(i);
        number[i] = hash32(stream, sample);
        light_u.set(i, sample_2d(stream, sample, ghost_dimension::light));
        entry_u.set(i, sample_2d(stream, sample, ghost_dimension::entry));
        if constexpr (scene_kind == SceneKind::any || disperses) {
            const Vec2f when = sample_2d(stream, sample, ghost_dimension::time);
            time[i] = when.x * all_times;
            place[i] = disperses ? when.y * static_cast<float>(camera.dispersion.cell_count) : 0.0f;
        } else {
            time[i] = place[i] = 0;
        }
    }
    for (int i = 0; i < N; ++i) {
        const LensFrame frame{camera_at(camera, time[i]), camera.front_vertex_m};
        const LightReceiver middle{frame.place_in_scene({0, 0, 0}), {0, 0, 0}, time[i]};
        picks[i] = pick_light(view, middle, light_kinds(view, middle), light_u[i], number[i]);
        const bool lit = picks[i].probability > 0.0f;
        from.set(i,
                 lit ? frame.direction(sample_picked<scene_kind>(view, middle, picks[i]).direction) : Vec3f{0, 0, 1});
    }
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        // The tangent of half the angle to the axis, infinite behind the camera.
        const float x = from.x[i], y = from.y[i], z = from.z[i], sine = std::sqrt(x * x + y * y);
        const float half_tangent = sine / (1.0f - z);
        const bool seen = (half_tangent < ghosts.largest_half_tangent) & (z < 0.9f);
        const int bin = static_cast<int>(select(seen, half_tangent / ghosts.largest_half_tangent, 0.0f) *
                                         static_cast<float>(kGhostAngles));
        const GhostEntry entry =
            ghosts.entries[way_number * kGhostAngles + select(bin < kGhostAngles, bin, kGhostAngles - 1)];
        const EntryPlace at = entry_place(entry, ghosts.reach, entry_u[i]);
        const float inverse = 1.0f / select(sine > 0.0f, sine, 1.0f);
        const float away_x = select(sine > 0.0f, x * inverse, 1.0f), away_y = y * inverse;
        rays.origin.set(i, {-at.along * z * away_x - at.across * away_y, -at.along * z * away_y + at.across * away_x,
                            at.along * sine});
        rays.direction.set(i, {0, 0, 1});
        rays.status[i] = select(seen, 0, static_cast<int>(RayStatus::vignetted));
        density[i] = at.density;
        if constexpr (disperses)
            variable[i] = camera.dispersion.variable.at(wavelength_at(camera.dispersion, place[i]));
        shadow.active[i] = 0;
    }
    for (int i = 0; i < N; ++i) {
        if (rays.status[i] != 0) continue;
        // The light as the place sees it, which may be near: from a direction of its own, through a plane that is
        // across the first.
        const LensFrame frame{camera_at(camera, time[i]), camera.front_vertex_m};
        const LightReceiver here{frame.place_in_scene(rays.origin[i]), {0, 0, 0}, time[i]};
        const LightSample light = sample_picked<scene_kind>(view, here, picks[i]);
        const Vec3f to_light = frame.direction(light.direction);
        const float cosine = dot(to_light, from[i]);
        if (is_black(light.irradiance) || !(cosine > 0.0f)) {
            rays.status[i] = static_cast<int>(RayStatus::vignetted);
            continue;
        }
        color.set(i, bounded_light((cosine / (density[i] * pixel_area * picks[i].probability * way.probability)) *
                                   light.irradiance));
        rays.direction.set(i, -to_light);
        const bool is_near = light.distance < kFarAway;
        shadow.origin.set(i, here.position);
        shadow.direction.set(i, is_near ? light.distance * light.direction : light.direction);
        shadow.far[i] = is_near ? (light.reach > 0.0f ? light.reach : 0.0f) : kFarAway;
    }

    PassedPower<N> passed;
    const GhostMedia<kTerms, N> media = [&] {
        if constexpr (disperses)
            return GhostMedia<kTerms, N>{ghosts.indices + way.first, ghosts.spectral_coatings + way.first, variable,
                                         passed};
        else
            return GhostMedia<kTerms, N>{nullptr, ghosts.coatings + way.first, nullptr, passed};
    }();
    trace_lens<lens_kind>(lens, rays, NoRecord{}, media);

    alignas(kLaneAlignment<std::int32_t, N>) std::int32_t pixel[N], hidden[N];
    std::int32_t any = 0;
    for (int i = 0; i < N; ++i) {
        if (rays.status[i] != 0) continue;
        const Vec3f o = rays.origin[i], d = rays.direction[i];
        const float way_to_film = (camera.film_distance - o.z) / d.z;
        pixel[i] = pixel_at(camera, o.x + way_to_film * d.x, o.y + way_to_film * d.y);
        if (pixel[i] < 0) continue;
        Color c = passed.of_unpolarised(i) * color[i];
        if constexpr (disperses) {
            constexpr float kAll[kSharedWavelengths] = {1, 1, 1};
            c = film_color(camera.dispersion, place[i], 1, kAll, c);
        }
        if constexpr (scene_kind == SceneKind::any) {
            // A row sees what falls on it while it is exposed.
            const float begin = static_cast<float>(pixel[i] / camera.width) * camera.row_time;
            if (camera.row_time > 0.0f) {
                if (time[i] < begin || time[i] > begin + camera.exposed_time) continue;
                c = (all_times / camera.exposed_time) * c;
            }
            shadow.number[i] = shadow_ray_number(number[i]);
            shadow.time[i] = time[i];
        }
        color.set(i, c);
        shadow.active[i] = any = 1;
    }
    if (!any) return;
    scene.occluded(shadow, hidden);
    for (int i = 0; i < N; ++i)
        if (shadow.active[i] && !hidden[i]) splat(pixel[i], color[i], unit_float(hash32(number[i])));
}

}  // namespace REALCAM_NAMESPACE
