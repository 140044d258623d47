#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "../optics/pupil/pupil_tracer.hpp"
#include "../optics/trace/lens_path.hpp"
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

/// The largest distance of a surface's rim from its vertex plane, mm.
double rim_depth(const Surface& surface);

/// Radius of a circle in the vertex plane through which all light goes that meets the surface, mm.
double reach_of(const Surface& surface);

/// Radius of a circle about the origin of the camera's frame (film_path_ends), across light from anywhere, that holds
/// all places where light enters a lens of any kind, mm.
float entry_reach(const LensSystem& lens);

/// The lens with a round stop: the circle around what its blades leave open.
LensSystem with_stop_around_blades(LensSystem lens);

/// Sets what is known of a ray that has left the lens with origin o and unit direction d.
void set_front(Vec3f o, Vec3f d, FoundRay& ray);

/// Looks for where light has to enter: by rays back from the film, because there their bundles are wide, while those of
/// a fisheye are a hundredth of its front. Lens and circle of film are round, so that one radius of the film is enough;
/// blades are taken for the circle around their opening. A ghost's bundle may be narrow: it is looked for with the stop
/// wide open first, then with its own, and at last in the rectangle that holds what was found.
struct EntrySearch {
    using Found = FoundRay;

    /// `film_radius`: of a circle that holds the film, mm.
    EntrySearch(const LensSystem& lens, double film_radius, const PupilTracer& tracer);

    /// `way`: of light to the film; `lens`: to whose surfaces it belongs.
    std::vector<FoundRay> along(const LensSystem& lens, const std::vector<Crossing>& way) const;

    /// Radii of circles that hold all places where light enters the lens, and through which it leaves it, mm.
    float front_reach() const { return front_reach_; }
    double rear_reach() const { return rear_reach_; }

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
    Rectangle all_directions(int ring) const;

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

    /// Starts a ray at the middle of a ring of film, along the middle of one of the squares of a rectangle.
    void start(const Rectangle& in, int rows, int square, int lane, PupilTracer::Rays& rays, FoundRay& ray) const;

    /// What holds the squares of all rays that were found in a ring or beside it; where there are none, as before.
    static Directions around(const std::vector<FoundRay>& rays, const Directions& before);

    double film_radius, film_distance;  ///< mm
    double film_index;  ///< of the medium before the film
    float front_reach_;
    double rear_reach_;
    const PupilTracer& tracer;
};

/// An upper bound of the tangents of half the angles of these rays.
float largest_half_tangent_of(const std::vector<FoundRay>& rays);

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
GhostEntries entries_of(const std::vector<FoundRay>& rays, float largest_half_tangent);

/// Where it leaves the lens, for places on the film in even steps of their radius.
GhostEntries exits_of(const std::vector<FoundRay>& rays);

double etendue_of(const std::vector<FoundRay>& rays);

}  // namespace REALCAM_NAMESPACE
