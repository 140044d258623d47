#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "../optics/lens_path.hpp"
#include "../optics/pupil_tracer.hpp"
#include "ghost_view.hpp"

namespace REALCAM_NAMESPACE {

/// A ray from the film that has left the lens by some way.
struct FoundRay {
    float half_tangent;  ///< of its angle to the axis
    Vec2f front;  ///< place in the plane across it, through the front vertex: away from the axis, and beside, mm
    int film_ring;  ///< of kGhostBins, in which it began
    Vec2f rear;  ///< place in the plane of the last vertex: towards its film point, and beside, mm
    Vec2f cosines, square;  ///< of its direction at the film: towards the radius, and beside; sides of its square
    float etendue;          ///< mm^2 sr
};

namespace entry_search_detail {

/// Radius of a circle in the vertex plane through which all light goes that meets the surface, mm.
inline double reach_of(const Surface& surface) {
    return 1.02 * std::hypot(surface.clear_semi_diameter, surface.sag(surface.clear_semi_diameter));
}

}  // namespace entry_search_detail

/// Radius of a circle in the plane of the last vertex through which all light goes to the film, mm.
inline double exit_reach(const LensSystem& lens) {
    return entry_search_detail::reach_of(lens.surfaces.back());
}

/// Radius of a circle that holds all places where light enters a lens, mm.
inline float entry_reach(const LensSystem& lens) {
    return static_cast<float>(entry_search_detail::reach_of(lens.surfaces.front()));
}

/// Looks for where light has to enter: by rays back from the film, because there their bundles are wide, while those of
/// a fisheye are a hundredth of its front. Lens and circle of film are round, so that one radius of the film is enough;
/// blades are taken for the circle around their opening. A ghost's bundle may be narrow: it is looked for with the stop
/// wide open first, then with its own, and at last in the rectangle that holds what was found.
struct EntrySearch {
    /// `film_radius`: of a circle that holds the film, mm.
    EntrySearch(const LensSystem& lens, double film_radius, const PupilTracer& tracer)
        : film_radius(film_radius),
          film_distance(lens.film_distance),
          film_index(lens.indices(lens.wavelength_nm).back()),
          rear_reach(exit_reach(lens)),
          tracer(tracer) {}

    /// `way`: of light to the film; `lens`: to whose surfaces it belongs.
    std::vector<FoundRay> along(const LensSystem& lens, const std::vector<Crossing>& way) const {
        const LensSystem round = with_round_stop(lens);
        LensSystem open = round;
        open.stop_semi_diameter = open.stop().clear_semi_diameter;
        Directions directions;
        for (int ring = 0; ring < kGhostBins; ++ring) directions[static_cast<std::size_t>(ring)] = all_directions(ring);
        directions = around(traced<kFew>(open, way, directions), directions);
        directions = around(traced<kFew>(round, way, directions), directions);
        return traced<kMany>(round, way, directions);
    }

private:
    /// Rows of directions that are looked along; there are twice as many columns.
    static constexpr int kFew = 8, kMany = 12;

    /// Direction cosines: from low to high along the film point's radius, from 0 to `across` beside it. None: across 0.
    struct Rectangle {
        double low, high, across;
    };
    using Directions = std::array<Rectangle, kGhostBins>;  ///< of each ring of the film

    double radius_of(int ring) const { return (ring + 0.5) * film_radius / kGhostBins; }

    /// To the circle behind the lens.
    Rectangle all_directions(int ring) const {
        const double r = radius_of(ring);
        const auto cosine_to = [&](double away) { return away / std::hypot(away, film_distance); };
        return {cosine_to(-rear_reach - r), cosine_to(rear_reach - r), cosine_to(rear_reach)};
    }

    template <int kRows>
    std::vector<FoundRay> traced(const LensSystem& lens, const std::vector<Crossing>& way,
                                 const Directions& directions) const {
        constexpr int kPerRing = 2 * kRows * kRows, kCount = kGhostBins * kPerRing;
        static_assert(kCount % PupilTracer::kBlock == 0);
        const LensPath<float> back(lens, way, LightDirection::to_scene, lens.wavelength_nm);
        std::vector<FoundRay> found;
        for (int first = 0; first < kCount; first += PupilTracer::kBlock) {
            PupilTracer::Rays rays;
            FoundRay looked[PupilTracer::kBlock];
            for (int k = 0; k < PupilTracer::kBlock; ++k) {
                const int ring = (first + k) / kPerRing, square = (first + k) % kPerRing;
                looked[k].film_ring = ring;
                start(directions[static_cast<std::size_t>(ring)], kRows, square, k, rays, looked[k]);
            }
            tracer.trace(back.view(), rays);
            for (int k = 0; k < PupilTracer::kBlock; ++k) {
                if (rays.status[k] != 0) continue;
                set_front(rays.origin[k], normalized(rays.direction[k]), looked[k]);
                found.push_back(looked[k]);
            }
        }
        return found;
    }

    /// From the middle of a ring of film along the middle of one of the squares of a rectangle.
    void start(const Rectangle& in, int rows, int square, int lane, PupilTracer::Rays& rays, FoundRay& ray) const {
        const double r = radius_of(ray.film_ring), ring = film_radius / kGhostBins;
        const double column = (in.high - in.low) / (2 * rows), row = in.across / rows;
        const double x = in.low + (square % (2 * rows) + 0.5) * column, y = (square / (2 * rows) + 0.5) * row;
        const double z2 = 1 - x * x - y * y, z = std::sqrt(std::max(z2, 0.0));
        rays.origin.set(lane, static_cast<Vec3f>(Vec3d{r, 0, film_distance}));
        rays.direction.set(lane, static_cast<Vec3f>(film_index * Vec3d{x, y, -z}));
        rays.status[lane] = z2 > 0 && row > 0 ? 0 : static_cast<int>(RayStatus::vignetted);
        ray.cosines = {static_cast<float>(x), static_cast<float>(y)};
        ray.square = {static_cast<float>(column), static_cast<float>(row)};
        ray.rear = {static_cast<float>(r + x / z * film_distance), static_cast<float>(y / z * film_distance)};
        // Twice, for the other half of the circle.
        ray.etendue = static_cast<float>(2 * 2 * std::numbers::pi * r * ring * column * row);
    }

    static void set_front(Vec3f o, Vec3f d, FoundRay& ray) {
        const float sine = std::sqrt(d.x * d.x + d.y * d.y);
        const Vec2f away = sine > 0 ? Vec2f{d.x / sine, d.y / sine} : Vec2f{1, 0};
        ray.half_tangent = sine / (1 - d.z);
        ray.front = {dot(o, Vec3f{-d.z * away.x, -d.z * away.y, sine}), -away.y * o.x + away.x * o.y};
    }

    /// What holds the squares of all rays that were found in a ring or beside it; where there are none, as before.
    static Directions around(const std::vector<FoundRay>& rays, const Directions& before) {
        Directions own{}, around{};
        const auto unite = [](Rectangle& a, const Rectangle& b) {
            if (b.across == 0) return;
            a = a.across == 0
                    ? b
                    : Rectangle{std::min(a.low, b.low), std::max(a.high, b.high), std::max(a.across, b.across)};
        };
        for (const FoundRay& ray : rays) {
            const double x = static_cast<double>(ray.cosines.x), y = static_cast<double>(ray.cosines.y);
            const double wide = 1.5 * static_cast<double>(ray.square.x), high = 1.5 * static_cast<double>(ray.square.y);
            unite(own[static_cast<std::size_t>(ray.film_ring)], {x - wide, x + wide, y + high});
        }
        for (int ring = 0; ring < kGhostBins; ++ring) {
            Rectangle& here = around[static_cast<std::size_t>(ring)];
            for (int beside = std::max(0, ring - 1); beside <= std::min(kGhostBins - 1, ring + 1); ++beside)
                unite(here, own[static_cast<std::size_t>(beside)]);
            if (here.across == 0) here = before[static_cast<std::size_t>(ring)];
        }
        return around;
    }

    /// Whose stop is the circle around what its blades leave open.
    static LensSystem with_round_stop(LensSystem lens) {
        if (lens.iris.blades == 0 || lens.is_wide_open()) return lens;
        const double rim = lens.stop().clear_semi_diameter;
        const Iris<double> open = open_iris(lens.iris, lens.stop_semi_diameter, rim);
        const double corner =
            opening_radius(open.apothem, open.curvature, std::cos(std::numbers::pi / lens.iris.blades));
        lens.stop_semi_diameter = std::min(corner, rim);
        lens.iris.blades = 0;
        return lens;
    }

    double film_radius, film_distance;  ///< mm
    double film_index;  ///< of the medium before the film
    double rear_reach;
    const PupilTracer& tracer;
};

/// Of which all angles of these rays are less.
inline float largest_half_tangent_of(const std::vector<FoundRay>& rays) {
    float largest = 0;
    for (const FoundRay& ray : rays) largest = std::max(largest, ray.half_tangent);
    return largest * (1 + 1.0f / kGhostBins);
}

using GhostEntries = std::array<GhostEntry, kGhostBins>;

namespace entry_search_detail {

/// Rectangles around all places of each bin. A margin of a sixteenth on each side, and the neighbours' rectangles, for
/// what lies between the rays.
template <class BinOf>
GhostEntries entries_around(const std::vector<FoundRay>& rays, Vec2f FoundRay::* place, BinOf&& bin_of) {
    GhostEntries own{}, entries{};
    for (const FoundRay& ray : rays) {
        const Vec2f at = ray.*place;
        GhostEntry& entry = own[static_cast<std::size_t>(std::clamp(bin_of(ray), 0, kGhostBins - 1))];
        if (entry.half_width == 0) entry = {at.x, at.x, 0};
        entry.low = std::min(entry.low, at.x);
        entry.high = std::max(entry.high, at.x);
        // Never 0, which means that there is none.
        entry.half_width = std::max({entry.half_width, std::fabs(at.y), 1e-6f});
    }
    for (int i = 0; i < kGhostBins; ++i) {
        GhostEntry& entry = entries[static_cast<std::size_t>(i)];
        for (int j = std::max(0, i - 1); j <= std::min(kGhostBins - 1, i + 1); ++j) {
            const GhostEntry& other = own[static_cast<std::size_t>(j)];
            if (other.half_width == 0) continue;
            if (entry.half_width == 0) entry = other;
            entry = {std::min(entry.low, other.low), std::max(entry.high, other.high),
                     std::max(entry.half_width, other.half_width)};
        }
        const float margin = 0.0625f * std::max(entry.high - entry.low, entry.half_width);
        entry.low -= margin;
        entry.high += margin;
        entry.half_width += entry.half_width > 0 ? margin : 0;
    }
    return entries;
}

}  // namespace entry_search_detail

/// Where light enters whose rays were found, in even steps up to the largest half tangent.
inline GhostEntries entries_of(const std::vector<FoundRay>& rays, float largest_half_tangent) {
    return entry_search_detail::entries_around(rays, &FoundRay::front, [&](const FoundRay& ray) {
        return static_cast<int>(ray.half_tangent / largest_half_tangent * static_cast<float>(kGhostBins));
    });
}

/// Where it leaves the lens, for places on the film in even steps of their radius.
inline GhostEntries exits_of(const std::vector<FoundRay>& rays) {
    return entry_search_detail::entries_around(rays, &FoundRay::rear,
                                               [](const FoundRay& ray) { return ray.film_ring; });
}

inline double etendue_of(const std::vector<FoundRay>& rays) {
    double sum = 0;
    for (const FoundRay& ray : rays) sum += static_cast<double>(ray.etendue);
    return sum;
}

}  // namespace REALCAM_NAMESPACE
