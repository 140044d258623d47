#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "../optics/pupil/pupil_tracer.hpp"
#include "../optics/trace/lens_path.hpp"
#include "ghost_view.hpp"

namespace REALCAM_NAMESPACE {

/// Ray from the film that has left the lens along some optical path.
struct FoundRay {
    float half_tangent;  ///< tangent of half its angle to the axis
    Vec2f front;  ///< point in the plane perpendicular to it through the front vertex: away from the axis, and across,
                  ///< mm
    int film_ring;  ///< index of the film ring of its origin, of kGhostBins
    Vec2f rear;  ///< point in the plane of the last vertex: towards its film point, and across, mm
    Vec2f cosines, square;  ///< direction cosines at the film, along the film radius and across; size of its stratum in
                            ///< them
    float etendue;  ///< mm^2 sr
};

/// Largest distance of a surface's rim from its vertex plane, mm.
double rim_depth(const Surface& surface);

/// Radius of a circle in the vertex plane through which all light passes that hits the surface, mm.
double reach_of(const Surface& surface);

/// Radius of a disc about the origin of the camera's frame (film_path_ends), perpendicular to light from any direction,
/// that contains all points where light enters a lens of any kind, mm.
float entry_reach(const LensSystem& lens);

/// The lens with a circular stop: the circumcircle of the opening that its blades leave.
LensSystem with_stop_around_blades(LensSystem lens);

/// Sets half_tangent and front of a ray that has left the lens with origin o and unit direction d.
void set_front(Vec3f o, Vec3f d, FoundRay& ray);

/// Entrance-pupil search: finds the entrance-pupil bounds by rays traced back from the film, where bundles are wide. At
/// the front of a fisheye they cover only a hundredth of its first surface. Lens and film circle are rotationally
/// symmetric, so one azimuth of the film is enough; blades are replaced by the circumcircle of their opening. A ghost's
/// bundle may be narrow: it is searched with the stop wide open first, then with the actual stop, and finally within
/// the bounds of the rays found.
struct EntrancePupilSearch {
    using Found = FoundRay;

    /// `film_radius`: radius of a circle that contains the film, mm.
    EntrancePupilSearch(const LensSystem& lens, double film_radius, const PupilTracer& tracer);

    /// Rays that pass along an optical path. `way`: its crossings, in the direction of light to the film; `lens`: the
    /// lens whose surfaces they index.
    std::vector<FoundRay> along(const LensSystem& lens, const std::vector<Crossing>& way) const;

    /// Radii of circles that contain all points where light enters the lens, and where it leaves it, mm.
    float front_reach() const { return front_reach_; }
    double rear_reach() const { return rear_reach_; }

private:
    /// Rows of traced directions; there are twice as many columns.
    static constexpr int kFew = 8, kMany = 12;

    /// Bounds of direction cosines: low to high along the film point's radius, 0 to `across` perpendicular to it. Empty
    /// if `across` is 0.
    struct Rectangle {
        double low, high, across;
    };
    using Directions = std::array<Rectangle, kGhostBins>;  ///< one for each film ring

    double radius_of(int ring) const { return (ring + 0.5) * film_radius / kGhostBins; }

    /// Directions from a film ring to the circle behind the lens.
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

    /// Starts a ray at the middle of a film ring, through the centre of one stratum of a rectangle of directions.
    void start(const Rectangle& in, int rows, int square, int lane, PupilTracer::Rays& rays, FoundRay& ray) const;

    /// Bounds of the strata of all rays found in a ring and its neighbours; those of `before` if there are no rays.
    static Directions around(const std::vector<FoundRay>& rays, const Directions& before);

    double film_radius, film_distance;  ///< mm
    double film_index;  ///< refractive index of the medium in front of the film
    float front_reach_;
    double rear_reach_;
    const PupilTracer& tracer;
};

/// Upper bound of the tangents of half the angles of these rays to the axis.
float largest_half_tangent_of(const std::vector<FoundRay>& rays);

using GhostEntries = std::array<GhostEntry, kGhostBins>;

namespace entrance_pupil_search_detail {

/// Bounding rectangles of the points of each bin and its neighbours. A margin of a sixteenth on each side covers the
/// gaps between the rays.
template <class BinOf>
GhostEntries entries_around(const std::vector<FoundRay>& rays, Vec2f FoundRay::* place, BinOf&& bin_of) {
    GhostEntries own{}, entries{};
    for (const FoundRay& ray : rays) {
        const Vec2f at = ray.*place;
        GhostEntry& entry = own[static_cast<std::size_t>(std::clamp(bin_of(ray), 0, kGhostBins - 1))];
        if (entry.half_width == 0) entry = {at.x, at.x, 0};
        entry.low = std::min(entry.low, at.x);
        entry.high = std::max(entry.high, at.x);
        // Positive, because 0 marks an empty entry.
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

}  // namespace entrance_pupil_search_detail

/// Entrance-pupil bounds of the rays, in uniform steps of the half tangent up to the largest one.
GhostEntries entries_of(const std::vector<FoundRay>& rays, float largest_half_tangent);

/// Bounds of the rays in the plane of the last vertex, in uniform steps of the film radius.
GhostEntries exits_of(const std::vector<FoundRay>& rays);

double etendue_of(const std::vector<FoundRay>& rays);

}  // namespace REALCAM_NAMESPACE
