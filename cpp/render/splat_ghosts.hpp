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

/// Share of the samples that enter anywhere, for what the entries' rectangles have missed.
inline constexpr float kAnywhere = 1.0f / 16;

/// A place in front of the lens, in the plane across light of one direction.
struct EntryPlace {
    float along, across;  ///< away from the axis, and across that, mm
    float density;        ///< per mm^2
};

REALCAM_INLINE EntryPlace entry_place(const GhostEntry& entry, float reach, Vec2f u) {
    const float area = 2.0f * entry.half_width * (entry.high - entry.low), whole = 4.0f * reach * reach;
    const float anywhere = select(area > 0.0f, kAnywhere, 1.0f);
    const bool everywhere = u.x < anywhere;
    const float fresh = select(everywhere, u.x / anywhere, (u.x - anywhere) / (1.0f - kAnywhere));
    const float along = select(everywhere, reach * (2.0f * fresh - 1.0f), entry.low + fresh * (entry.high - entry.low));
    const float across = (2.0f * u.y - 1.0f) * select(everywhere, reach, entry.half_width);
    const bool inside = (along >= entry.low) & (along <= entry.high) & (std::fabs(across) <= entry.half_width);
    const float density = anywhere / whole + select(inside & (area > 0.0f), (1.0f - anywhere) / area, 0.0f);
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

    LensRays<float, N> rays;
    SceneRays<N> shadow;
    ColorLanes<N> color;
    alignas(kLaneAlignment<float, N>) float place[N], variable[N], time[N];
    alignas(kLaneAlignment<std::uint32_t, N>) std::uint32_t number[N];
    for (int i = 0; i < N; ++i) {
        const std::uint32_t sample = block * kGhostBlock + first + static_cast<std::uint32_t>(i);
        const auto random = [&](std::uint32_t of) { return sample_2d(stream, sample, of); };
        number[i] = hash32(stream, sample);
        const Vec2f when = random(ghost_dimension::time);
        time[i] = 0;
        if constexpr (scene_kind == SceneKind::any)
            time[i] = when.x * (camera.exposed_time + camera.row_time * static_cast<float>(camera.height));
        place[i] = variable[i] = 0;
        if constexpr (disperses) {
            place[i] = when.y * static_cast<float>(camera.dispersion.cell_count);
            variable[i] = camera.dispersion.variable.at(wavelength_at(camera.dispersion, place[i]));
        }
        // A light is chosen for the middle of the lens.
        const LensFrame frame{camera_at(camera, time[i]), camera.front_vertex_m};
        const LightReceiver middle{frame.place_in_scene({0, 0, 0}), {0, 0, 0}, time[i]};
        const LightPick pick =
            pick_light(view, middle, light_kinds(view, middle), random(ghost_dimension::light), number[i]);
        rays.status[i] = static_cast<int>(RayStatus::vignetted);
        shadow.active[i] = 0;
        if (!(pick.probability > 0.0f)) continue;
        const Vec3f from = frame.direction(sample_picked<scene_kind>(view, middle, pick).direction);
        const float sine = std::sqrt(from.x * from.x + from.y * from.y), angle = std::atan2(sine, -from.z);
        if (!(angle < ghosts.largest_angle)) continue;
        const int bin = static_cast<int>(angle / ghosts.largest_angle * kGhostAngles);
        const GhostEntry entry =
            ghosts.entries[way_number * kGhostAngles + select(bin < kGhostAngles, bin, kGhostAngles - 1)];
        const EntryPlace at = entry_place(entry, ghosts.reach, random(ghost_dimension::entry));
        const Vec2f away = sine > 0.0f ? Vec2f{from.x / sine, from.y / sine} : Vec2f{1, 0};
        const Vec3f start = {-at.along * from.z * away.x - at.across * away.y,
                             -at.along * from.z * away.y + at.across * away.x, at.along * sine};
        // Its light there, which may be near: from a direction of its own, through a plane that is across the first.
        const LightReceiver here{frame.place_in_scene(start), {0, 0, 0}, time[i]};
        const LightSample light = sample_picked<scene_kind>(view, here, pick);
        const Vec3f to_light = frame.direction(light.direction);
        const float cosine = dot(to_light, from);
        if (is_black(light.irradiance) || !(cosine > 0.0f)) continue;
        color.set(i, bounded_light((cosine / (at.density * pixel_area * pick.probability * way.probability)) *
                                   light.irradiance));
        rays.origin.set(i, start);
        rays.direction.set(i, -to_light);
        rays.status[i] = 0;
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
            const float all = camera.exposed_time + camera.row_time * static_cast<float>(camera.height);
            if (camera.row_time > 0.0f) {
                if (time[i] < begin || time[i] > begin + camera.exposed_time) continue;
                c = (all / camera.exposed_time) * c;
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
