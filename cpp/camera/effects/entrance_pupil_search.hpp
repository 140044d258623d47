#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "../../optics/pupil/film_surface.hpp"
#include "../../optics/pupil/pupil_tracer.hpp"
#include "../../optics/pupil/pupil_view.hpp"
#include "../../optics/trace/film_frame.hpp"
#include "ghosts/ghost_view.hpp"

namespace REALCAM_NAMESPACE {

/// Ray from the film that has left the lens along some optical path.
struct FoundRay {
    Vec2f half_tangents;  ///< half_tangents() of its direction; for a rotationally symmetric lens, their length and 0
    Vec2f front;  ///< where it leaves the lens, in the plane of a GhostEntry, mm
    int film_cell;  ///< index of the cell of the film map that contains its origin
    Vec2f target, stratum;  ///< point that it was sent to, see EntrancePupilSearch, and the size of its stratum
    Vec2f rear;  ///< point in the plane of the last vertex, mm: towards its film point, and across; for a lens without
                 ///< rotational symmetry, point in the plane z = 0 of the film's frame
    float etendue;  ///< mm^2 sr
};

/// Radius of a disc about the origin of the camera's frame (film_path_ends), perpendicular to light from any direction,
/// that contains all points where light enters a lens of any kind, mm.
float entry_reach(const LensSystem& lens);

/// Rectangle of points in the coordinates of FoundRay::target.
template <class T>
struct TargetRectangle {
    Vec2<T> low, high;
};

/// Stratum of a TargetRectangle: its column and row, the size of a stratum, and its index among all strata.
template <class T>
struct TargetStratum {
    int column, row;
    Vec2<T> size;
    std::uint32_t index;
};

/// Directions of the light of a rotationally symmetric lens, in uniform steps of the tangent of half the angle to the
/// axis.
struct HalfTangentBins {
    float largest;  ///< upper bound of the tangents

    /// Index of the bin of a tangent; beyond the largest tangent, that of the last bin.
    int bin_of(float half_tangent) const;
    int cell_of(Vec2f half_tangents) const { return bin_of(half_tangents.x); }
};

using FoundRays = std::vector<std::vector<FoundRay>>;

// Film maps of EntrancePupilSearch: a division of the film into cells, kColumns x kRows, and the targets of the rays
// from each cell.

/// Film map of a rotationally symmetric lens: rings of the film radius. One azimuth of the film is enough, and one half
/// of each bundle. Targets are direction cosines at the film, along the film radius and across it, so that rays are
/// evenly spread over the light.
struct FilmRings {
    static constexpr int kColumns = kGhostBins, kRows = 1;
    static constexpr bool kMirrored = true;  ///< light is symmetric in the y of targets, and only y > 0 is searched
    /// Rows of strata of a target rectangle, in the first searches and in the last; and columns for each row.
    static constexpr int kFew = 8, kMany = 12, kColumnsPerRow = 2;
    using Real = double;

    /// `film_radius`: radius of a circle that contains the film, mm.
    FilmRings(const LensSystem& lens, double film_radius);

    double radius_of(int ring) const { return (ring + 0.5) * film_radius / kGhostBins; }
    /// Rectangle of all targets of a cell from which light reaches the film.
    TargetRectangle<double> all_targets(int ring) const;
    PathEnds ends() const { return {}; }
    /// Starts a ray from its cell, `ray.film_cell`, to a stratum.
    void start(const TargetRectangle<double>& in, const TargetStratum<double>& stratum, int lane,
               PupilTracer::Rays& rays, FoundRay& ray) const;
    /// Sets half_tangents and front of a ray that has left the lens with origin o and unit direction d.
    static void set_front(Vec3f o, Vec3f d, FoundRay& ray);
    /// Map that covers the directions of all these rays.
    static HalfTangentBins directions_of(const FoundRays& rays);

    double film_radius, film_distance;  ///< mm
    double film_index;  ///< refractive index of the medium in front of the film
    double rear_reach;  ///< radius of a circle that contains all points where light leaves the lens, mm
};

/// Film map of a lens without rotational symmetry: a square grid. Targets are points of the plane z = 0 of the film's
/// frame.
struct FilmCells {
    static constexpr int kColumns = kGhostColumns, kRows = kGhostColumns;
    static constexpr bool kMirrored = false;
    static constexpr int kFew = 8, kMany = 10, kColumnsPerRow = 1;
    using Real = float;

    /// `film_radius`: radius of a circle about the film's vertex that contains the film, mm.
    FilmCells(const LensSystem& lens, double film_radius);

    TargetRectangle<float> all_targets(int) const { return {{-rear_reach, -rear_reach}, {rear_reach, rear_reach}}; }
    const PathEnds& ends() const { return to_scene; }
    void start(const TargetRectangle<float>& in, const TargetStratum<float>& stratum, int lane, PupilTracer::Rays& rays,
               FoundRay& ray) const;
    static void set_front(Vec3f o, Vec3f d, FoundRay& ray);
    static GhostGrid directions_of(const FoundRays& rays);

    PathEnds to_scene;
    FilmSurface<float> film;
    float cell_size;  ///< mm
    float film_index;
    GhostGrid grid;
    float rear_reach;  ///< radius of a circle in the plane z = 0 that contains all light from the last surface, mm
};

/// Entrance-pupil search: finds the entrance-pupil bounds by rays traced back from the film, where bundles are wide. At
/// the front of a fisheye they cover only a hundredth of its first surface. Blades are replaced by the circumcircle of
/// their opening. A ghost's bundle may be narrow: it is searched with the stop wide open first, then with the actual
/// stop, and finally within the bounds of the rays found.
template <class Map>
class EntrancePupilSearch {
public:
    EntrancePupilSearch(const LensSystem& lens, double film_radius, const PupilTracer& tracer)
        : map_(lens, film_radius), tracer_(tracer) {}

    const Map& map() const { return map_; }

    /// Rays that pass along an optical path. `crossings`: in the direction of light to the film; `lens`: the
    /// lens whose surfaces they index.
    std::vector<FoundRay> along(const LensSystem& lens, const std::vector<Crossing>& crossings) const;

private:
    static constexpr int kCells = Map::kColumns * Map::kRows;
    using Real = typename Map::Real;
    using Rectangle = TargetRectangle<Real>;
    using Targets = std::array<Rectangle, kCells>;  ///< of each cell

    template <int kStrataRows>
    std::vector<FoundRay> traced(const LensSystem& lens, const std::vector<Crossing>& crossings,
                                 const Targets& targets) const;

    /// Bounds of the strata of all rays found in a cell and its neighbours; those of `before` if there are no rays.
    static Targets around(const std::vector<FoundRay>& rays, const Targets& before);

    Map map_;
    const PupilTracer& tracer_;
};

/// Entrance-pupil bounds of the light of an optical path, for each cell of the directions.
template <class Map, class Directions>
std::vector<GhostEntry> entries_of(const std::vector<FoundRay>& rays, const Directions& directions);

/// Bounds of the rays where they leave the lens towards the film (FoundRay::rear), for each cell of the film map.
template <class Map>
std::vector<GhostEntry> exits_of(const std::vector<FoundRay>& rays);

double etendue_of(const std::vector<FoundRay>& rays);

/// Entrance-pupil bounds of light from far away that reaches the film, by its angle to the axis; found with rays
/// through the pupil.
class PupilEntries {
public:
    /// `lens`: for light from the film to the scene. `film_radius`: radius of a circle that contains the film;
    /// `film_distance`: from the last vertex to the film, mm.
    PupilEntries(const PupilView& pupil, const LensView<float>& lens, double film_radius, double film_distance,
                 const PupilTracer& tracer);

    /// Upper bound of the tangents of half the angles to the axis of light that reaches the film.
    float largest_half_tangent() const { return directions_.largest; }
    /// Bounds for the tangent of half the angle to the axis; beyond the largest tangent, those of the last bin.
    const GhostEntry& at(float half_tangent) const {
        return entries_[static_cast<std::size_t>(directions_.bin_of(half_tangent))];
    }

private:
    HalfTangentBins directions_;
    std::vector<GhostEntry> entries_;
};

}  // namespace REALCAM_NAMESPACE
