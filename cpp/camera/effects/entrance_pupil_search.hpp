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

// Search for the entrance-pupil bounds of an optical path: rectangles in front of the lens through which light from a
// direction must pass to reach the film along that path.

/// Ray from the film that has left the lens along some optical path.
struct FoundRay {
    Vec2f half_tangents;  ///< half_tangents() of its direction; for a rotationally symmetric lens, their length and 0
    Vec2f front;  ///< where it leaves the lens, in the plane of a GhostBounds, mm
    int film_cell;  ///< index of the cell of the film map that contains its origin
    Vec2f target;  ///< point that it was sent to, in the coordinates of the film map (FilmRings, FilmCells)
    Vec2f stratum;  ///< size of its stratum in these coordinates
    Vec2f rear;  ///< point in the plane of the last vertex, mm: towards its film point, and across; for a lens without
                 ///< rotational symmetry, point in the plane z = 0 of the film's frame
    float etendue;  ///< etendue that it represents, mm^2 sr
};

/// Radius of a disc about the origin of the camera's frame (film_path_ends), perpendicular to light from any direction,
/// that contains all points where light enters a lens of any kind, mm.
float entry_reach(const LensSystem& lens);

/// Rectangle of points in the coordinates of FoundRay::target. `T`: float or double.
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

using FoundRays = std::vector<std::vector<FoundRay>>;  ///< rays of each of several optical paths

// Film maps of EntrancePupilSearch: a division of the film into cells, kColumns x kRows, and the targets of the rays
// from each cell.

/// Film map of a rotationally symmetric lens: rings of the film radius. One azimuth of the film is enough, and one half
/// of each bundle. Targets are direction cosines at the film, along the film radius and across it, so that rays are
/// evenly spread over the light.
struct FilmRings {
    static constexpr int kColumns = kGhostBins, kRows = 1;
    static constexpr bool kMirrored = true;  ///< light is symmetric in the y of targets, and only y > 0 is searched
    /// Number of rows of strata of a target rectangle, in the first searches and in the last one; and of columns for
    /// each row.
    static constexpr int kCoarseRows = 8, kFineRows = 12, kColumnsPerRow = 2;
    using Real = double;  ///< number type of target rectangles

    /// `film_radius`: radius of a circle that contains the film, mm.
    FilmRings(const LensSystem& lens, double film_radius);

    /// Film radius at the middle of a ring, mm.
    double radius_of(int ring) const { return (ring + 0.5) * film_radius / kGhostBins; }
    /// Rectangle of all targets of a cell from which light reaches the film.
    TargetRectangle<double> all_targets(int ring) const;
    PathEnds ends() const { return {}; }  ///< frames in which paths begin and end
    /// Starts the ray of a lane from its cell, `ray.film_cell`, to a stratum of the target rectangle `in`. Sets target,
    /// rear and etendue of `ray`.
    void start(const TargetRectangle<double>& in, const TargetStratum<double>& stratum, int lane,
               PupilTracer::Rays& rays, FoundRay& ray) const;
    /// Sets half_tangents and front of a ray that has left the lens with origin o and unit direction d.
    static void set_front(Vec3f o, Vec3f d, FoundRay& ray);
    /// Division of directions that covers those of all these rays.
    static HalfTangentBins directions_of(const FoundRays& rays);

    double film_radius, film_distance;  ///< mm
    double film_index;  ///< refractive index of the medium in front of the film
    double rear_reach;  ///< radius of a circle that contains all points where light leaves the lens, mm
};

/// Film map of a lens without rotational symmetry: a square grid. Targets are points of the plane z = 0 of the film's
/// frame.
struct FilmCells {
    static constexpr int kColumns = kGhostColumns, kRows = kGhostColumns;
    // Members as in FilmRings.
    static constexpr bool kMirrored = false;
    static constexpr int kCoarseRows = 8, kFineRows = 10, kColumnsPerRow = 1;
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
    float film_index;  ///< refractive index of the medium in front of the film
    GhostGrid grid;  ///< cells of the film
    float rear_reach;  ///< radius of a circle in the plane z = 0 that contains all light from the last surface, mm
};

/// Entrance-pupil search: finds the entrance-pupil bounds by rays traced back from the film, where bundles are wide. At
/// the front of a fisheye they cover only a hundredth of its first surface. Blades are replaced by the circumcircle of
/// their opening. A ghost's bundle may be narrow: it is searched with the stop wide open first, then with the actual
/// stop, and finally within the bounds of the rays found.
/// `Map`: FilmRings or FilmCells.
template <class Map>
class EntrancePupilSearch {
public:
    /// `film_radius`: radius of a circle that contains the film, mm. `tracer` must outlive the object.
    EntrancePupilSearch(const LensSystem& lens, double film_radius, const PupilTracer& tracer)
        : map_(lens, film_radius), tracer_(tracer) {}

    const Map& map() const { return map_; }

    /// Rays that pass along an optical path; empty if no light does. `crossings`: of the path, in the direction of
    /// light to the film; `lens`: the lens whose surfaces they index.
    std::vector<FoundRay> find_rays(const LensSystem& lens, const std::vector<Crossing>& crossings) const;

private:
    static constexpr int kCells = Map::kColumns * Map::kRows;
    using Real = typename Map::Real;
    using Rectangle = TargetRectangle<Real>;
    using Targets = std::array<Rectangle, kCells>;  ///< one rectangle for each cell of the film map

    /// Traces one ray to each stratum of each cell's target rectangle; returns those that leave the lens.
    template <int kStrataRows>
    std::vector<FoundRay> trace_strata(const LensSystem& lens, const std::vector<Crossing>& crossings,
                                       const Targets& targets) const;

    /// For each cell: bounds of the strata of all rays found in it and its neighbours; those of `previous` if there are
    /// none.
    static Targets target_bounds(const std::vector<FoundRay>& rays, const Targets& previous);

    Map map_;
    const PupilTracer& tracer_;
};

/// Entrance-pupil bounds of the light of an optical path, for each cell of the directions; empty bounds for a cell
/// without rays. `Directions`: HalfTangentBins or GhostGrid.
template <class Map, class Directions>
std::vector<GhostBounds> entries_of(const std::vector<FoundRay>& rays, const Directions& directions);

/// Bounds of the rays where they leave the lens towards the film (FoundRay::rear), for each cell of the film map.
template <class Map>
std::vector<GhostBounds> exits_of(const std::vector<FoundRay>& rays);

/// Etendue of an optical path: the sum over its rays, mm^2 sr.
double etendue_of(const std::vector<FoundRay>& rays);

/// Entrance-pupil bounds of light from far away that reaches the film, by its angle to the axis; found with rays
/// through the pupil.
class PupilEntryBounds {
public:
    /// `lens`: for light from the film to the scene. `film_radius`: radius of a circle that contains the film;
    /// `film_distance`: from the last vertex to the film, mm.
    PupilEntryBounds(const PupilView& pupil, const LensView<float>& lens, double film_radius, double film_distance,
                     const PupilTracer& tracer);

    /// Upper bound of the tangents of half the angles to the axis of light that reaches the film.
    float largest_half_tangent() const { return directions_.largest; }
    /// Bounds for the tangent of half the angle to the axis; beyond the largest tangent, those of the last bin.
    const GhostBounds& at(float half_tangent) const {
        return entries_[static_cast<std::size_t>(directions_.bin_of(half_tangent))];
    }

private:
    HalfTangentBins directions_;
    std::vector<GhostBounds> entries_;
};

}  // namespace REALCAM_NAMESPACE
