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
    float etendue;  ///< mm^2 sr
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
/// a fisheye are a hundredth of its front. Lens and circle of film are round, so that one radius of the film is enough.
struct EntrySearch {
    static constexpr int kRadii = kGhostBins, kColumns = 24, kRows = kColumns / 2;

    /// `film_radius`: of a circle that holds the film, mm.
    EntrySearch(const LensSystem& lens, double film_radius, const PupilTracer& tracer)
        : film_radius(film_radius),
          film_distance(lens.film_distance),
          film_index(lens.indices(lens.wavelength_nm).back()),
          rear_reach(exit_reach(lens)),
          tracer(tracer) {}

    /// `way_back`: from the film to the scene.
    std::vector<FoundRay> along(const LensView<float>& way_back) const {
        constexpr int kCount = kRadii * kColumns * kRows;
        std::vector<FoundRay> found;
        for (int first = 0; first < kCount; first += PupilTracer::kBlock) {
            PupilTracer::Rays rays;
            FoundRay looked[PupilTracer::kBlock];
            for (int k = 0; k < PupilTracer::kBlock; ++k) start(first + k, k, rays, looked[k]);
            tracer.trace(way_back, rays);
            for (int k = 0; k < PupilTracer::kBlock; ++k) {
                if (rays.status[k] != 0) continue;
                set_front(rays.origin[k], normalized(rays.direction[k]), looked[k]);
                found.push_back(looked[k]);
            }
        }
        return found;
    }

private:
    static_assert(kRadii * kColumns * kRows % PupilTracer::kBlock == 0);

    /// From the middle of each ring of film in evenly spaced direction cosines to the circle behind the lens.
    void start(int number, int lane, PupilTracer::Rays& rays, FoundRay& ray) const {
        const int radius = number / (kColumns * kRows), square = number % (kColumns * kRows);
        const double ring = film_radius / kRadii, r = (radius + 0.5) * ring;
        const auto cosine_to = [&](double away) { return away / std::hypot(away, film_distance); };
        const double low = cosine_to(-rear_reach - r), high = cosine_to(rear_reach - r), most = cosine_to(rear_reach);
        const double column = (high - low) / kColumns, row = most / kRows;
        const double x = low + (square % kColumns + 0.5) * column, y = (square / kColumns + 0.5) * row;
        const double z2 = 1 - x * x - y * y, z = std::sqrt(std::max(z2, 0.0));
        rays.origin.set(lane, static_cast<Vec3f>(Vec3d{r, 0, film_distance}));
        rays.direction.set(lane, static_cast<Vec3f>(film_index * Vec3d{x, y, -z}));
        rays.status[lane] = z2 > 0 ? 0 : static_cast<int>(RayStatus::vignetted);
        ray.film_ring = radius;
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
