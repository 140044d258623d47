#include "light_entries.hpp"

#include <algorithm>
#include <cmath>

#include "../../math/hypotenuse.hpp"
#include "../../math/random.hpp"
#include "../ghosts/splat_ghosts.hpp"
#include "../path/emitter_hit.hpp"

namespace realcam {
namespace {

constexpr int kBlock = PupilTracer::kBlock;
/// Least number of hits that determine the bounds; with fewer, the search takes more rays and a wider margin.
constexpr int kEnoughHits = 32;
/// Limit on the repetitions of a search.
constexpr int kMaxRounds = 10;

/// Returns the tangent of half the angle between the axis and a direction in front of the lens, a unit vector.
float half_tangent_of(Vec3f from) {
    return hypotenuse(from.x, from.y) / (1 - from.z);
}

/// Returns the entry plane of a light in the axes of the lens, with the front vertex at the origin.
EntryPlane plane_in_lens(const TracedLight& light) {
    CameraFrame lens{};
    lens.right = {1, 0, 0};
    lens.up = {0, 1, 0};
    lens.backward = {0, 0, 1};
    return entry_plane(lens, 0, light);
}

}  // namespace

LightEntries::LightEntries(const SceneView& scene, const CameraView& camera, const CameraSetup& setup,
                           const PupilTracer& tracer)
    : scene_(scene),
      camera_(camera),
      to_film_(setup.effects().direct_lens_path().surfaces()),
      tracer_(tracer),
      pupil_entries_(setup.pupil_entries()),
      front_reach_(entry_reach(setup.camera().lens)) {}

LightEntries::LightPosition LightEntries::sample_position(const LightGroup& group, std::uint32_t index) const {
    const Vec2f u = sample_joint_2d(0, index, 1), v = sample_joint_2d(0, index, 2);
    const float time = v.x * splat_ghosts_detail::all_times(camera_);
    const CameraFrame frame = camera_at(camera_, time);
    const std::int32_t light = group.lights[static_cast<std::size_t>(v.y * static_cast<float>(group.lights.size()))];
    if (group.kind == TracedLightKind::sun) {
        const Vec3f towards = -scene_.suns[light].direction;
        const LensPlacement placement = placement_towards(camera_, frame, towards);
        return {to_camera_axes(placement, towards), placement.film};
    }
    Vec3f position;
    if (group.kind == TracedLightKind::point) {
        position = point_light_at(scene_, scene_.points[light], time).position;
    } else {
        const AreaLight triangle = area_light_at(scene_, scene_.areas[light], time);
        const Vec2f at = sample_triangle(u);
        position = triangle.corner + at.x * triangle.edge_u + at.y * triangle.edge_v;
    }
    const LensPlacement placement = placement_for(camera_, frame, position);
    const Vec3f from_front = position - front_vertex(placement, camera_.front_vertex_m);
    return {1000.0f * to_camera_axes(placement, from_front), placement.film};
}

LightEntries::Probe LightEntries::probe(const Positions& positions, const TracedLight& light, const PlaneRectangle& in,
                                        int count) const {
    const EntryPlane plane = plane_in_lens(light);
    const float columns_per_mm = static_cast<float>(camera_.width) / (2 * camera_.film_half_width);
    Probe probe;
    const auto widen = [&](PlaneRectangle& box, float along, float across) {
        if (probe.hits == 0) box = {along, along, across, across};
        box = {std::min(box.low_along, along), std::max(box.high_along, along), std::min(box.low_across, across),
               std::max(box.high_across, across)};
    };
    for (int first = 0; first < count; first += kBlock) {
        PupilTracer::Rays rays;
        Vec2f entries[kBlock];  // in the plane, mm
        for (int k = 0; k < kBlock; ++k) {
            const auto index = static_cast<std::uint32_t>(first + k);
            entries[k] = in.at(sample_joint_2d(0, index, 0));
            const Vec3f entry = entries[k].x * plane.along + entries[k].y * plane.across,
                        position = positions[index % positions.size()].from_front;
            const Vec3f direction = light.kind == TracedLightKind::sun ? -position : entry - position;
            rays.origin.set(k, entry);
            rays.direction.set(k, normalized(direction));
            rays.status[k] = dot(direction, plane.normal) < 0 ? 0 : static_cast<int>(RayStatus::vignetted);
        }
        tracer_.trace(to_film_, rays);
        for (int k = 0; k < kBlock; ++k) {
            if (rays.status[k] != 0) continue;
            Vec2f landing = film_surface(camera_).landing(rays.origin[k], rays.direction[k]);
            if (camera_.bundles.nodes)
                landing = picture_landing(camera_.bundles,
                                          positions[static_cast<std::size_t>(first + k) % positions.size()].chief_film,
                                          landing)
                              .film;
            const Vec2f film = {landing.x - camera_.film_centre.x, landing.y - camera_.film_centre.y};
            // A margin of one pixel, for other wavelengths and for diffraction.
            if (!(std::fabs(film.x) <= camera_.film_half_width + 1 / columns_per_mm) ||
                !(std::fabs(film.y) <= camera_.film_half_height + 1 / columns_per_mm))
                continue;
            widen(probe.entries, entries[k].x, entries[k].y);
            widen(probe.film, columns_per_mm * film.x, columns_per_mm * film.y);
            ++probe.hits;
        }
    }
    return probe;
}

std::optional<FoundLight> LightEntries::find(const LightGroup& group) const {
    TracedLight light{};
    light.kind = group.kind;
    Positions positions;
    Vec3f middle = {0, 0, 0};
    for (std::size_t k = 0; k < positions.size(); ++k) {
        positions[k] = sample_position(group, static_cast<std::uint32_t>(k));
        middle = middle + positions[k].from_front;
    }
    if (!(dot(middle, middle) > 0) || !std::isfinite(dot(middle, middle))) return std::nullopt;
    light.from = normalized(middle);
    const float sine = hypotenuse(light.from.x, light.from.y);
    const Vec2f away = sine > 0 ? Vec2f{light.from.x / sine, light.from.y / sine} : Vec2f{1, 0};
    light.along = {-light.from.z * away.x, -light.from.z * away.y, sine};
    // The light may lie outside the field of view of the front's centre, but within that of the point of the front that
    // is nearest to it.
    Vec3f nearest = middle;
    if (light.kind != TracedLightKind::sun) {
        nearest = (1.0f / static_cast<float>(positions.size())) * middle;
        const float off_axis = hypotenuse(nearest.x, nearest.y);
        nearest = {std::max(0.0f, off_axis - front_reach_), 0, nearest.z};
    }
    GhostBounds entry{};  // unknown: the whole front is searched
    if (pupil_entries_) {
        constexpr float kFieldMargin = 1.5f;  // the pupil's rays sample the field only at some angles
        if (!(half_tangent_of(normalized(nearest)) < kFieldMargin * pupil_entries_->largest_half_tangent()))
            return std::nullopt;
        entry = pupil_entries_->at(half_tangent_of(light.from));
    }
    // The bounds of the pupil are those of distant light. Those of a near light differ in position and size: the search
    // begins in a square about them of at least twice their size.
    const float middle_along = 0.5f * (entry.low + entry.high),
                reach = std::max({entry.high - entry.low, 2 * entry.half_width, front_reach_ / 64});
    const PlaneRectangle front = {-front_reach_, front_reach_, -front_reach_, front_reach_};
    PlaneRectangle in = {middle_along - reach, middle_along + reach, -reach, reach};
    bool is_front = entry.half_width == 0;
    if (is_front) in = front;
    Probe found;
    bool is_coarse = true;
    for (int round = 0; round < kMaxRounds; ++round) {
        // Points and suns get more rays: their light outside the rectangle would be lost, while pixel samples find that
        // of emissive triangles.
        int rays = light.kind == TracedLightKind::triangles ? kBlock : 4 * kBlock;
        found = probe(positions, light, in, rays);
        if (found.hits < kEnoughHits && rays == kBlock) found = probe(positions, light, in, rays = 4 * kBlock);
        if (found.hits == 0) {
            if (is_front) return std::nullopt;
            is_front = true;
            in = front;
            continue;
        }
        // A margin for light that passes between the traced rays: a fraction of the bounds of the hits, or of the mean
        // distance of the rays if that is larger.
        const auto widened = [&](float low, float high, float whole) {
            const float share = found.hits < kEnoughHits ? 1.0f : is_coarse ? 0.3f : 0.1f;
            const float margin = share * std::max(high - low, whole / std::sqrt(static_cast<float>(rays)));
            return std::pair(low - margin, high + margin);
        };
        const PlaneRectangle& box = found.entries;
        const auto [low, high] = widened(box.low_along, box.high_along, in.high_along - in.low_along);
        const auto [left, right] = widened(box.low_across, box.high_across, in.high_across - in.low_across);
        const bool is_inside = in.holds(low, left) && in.holds(high, right);
        if (is_inside || round + 1 == kMaxRounds) {
            in = {low, high, left, right};
            if (!is_coarse) break;
            is_coarse = false;
        } else {
            // The hits reach the border, because the bounds of the pupil rest on few rays near the axis: the rectangle
            // is doubled.
            const float along = 0.5f * (in.high_along - in.low_along), across = 0.5f * (in.high_across - in.low_across);
            in = {in.low_along - along, in.high_along + along, in.low_across - across, in.high_across + across};
        }
    }
    light.entries = in;
    const double wide = static_cast<double>(found.film.high_along - found.film.low_along),
                 high = static_cast<double>(found.film.high_across - found.film.low_across);
    return FoundLight{light, (wide + 1) * (high + 1)};
}

}  // namespace realcam
