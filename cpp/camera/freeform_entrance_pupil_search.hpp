#pragma once
#include <array>
#include <vector>

#include "../optics/pupil/film_surface.hpp"
#include "../optics/pupil/pupil_tracer.hpp"
#include "../optics/trace/film_frame.hpp"
#include "ghost_view.hpp"

namespace REALCAM_NAMESPACE {

/// Ray from the film that has left a lens of any kind along some optical path.
struct FreeFoundRay {
    Vec2f half_tangents;  ///< half_tangents() of its direction
    Vec2f front;  ///< point in the plane perpendicular to it through the origin of the camera's frame (light_axes), mm
    int film_cell;  ///< index of the cell of its origin, in the grid over the film
    Vec2f rear;  ///< point in the plane z = 0 of the film's frame, mm
    Vec2f rear_step;  ///< spacing of neighbouring rays in that plane, mm
    float etendue;  ///< mm^2 sr
};

/// EntrancePupilSearch for lenses without rotational symmetry: rays are traced back from a grid over the film through
/// points of a plane in front of it.
class FreeformEntrancePupilSearch {
public:
    using Found = FreeFoundRay;

    /// `film_radius`: radius of a circle about the film's vertex that contains the film, mm.
    FreeformEntrancePupilSearch(const LensSystem& lens, double film_radius, const PupilTracer& tracer);

    /// Rays that pass along an optical path. `way`: its crossings, in the direction of light to the film; `lens`: the
    /// lens whose surfaces they index.
    std::vector<FreeFoundRay> along(const LensSystem& lens, const std::vector<Crossing>& way) const;

    /// Bounds of the light of an optical path: at the front, for each cell of the grid of directions; and in the plane
    /// z = 0 of the film's frame, for each cell of the film grid.
    static std::vector<FreeGhostEntry> entries_of(const std::vector<FreeFoundRay>& rays, const GhostGrid& directions);
    static std::vector<FreeGhostEntry> exits_of(const std::vector<FreeFoundRay>& rays);

    const GhostGrid& film_grid() const { return film_grid_; }
    /// Radius of a disc about the origin, perpendicular to light from any direction, that contains all light that hits
    /// the front surface; and radius of a circle in the plane z = 0 of the film's frame that contains all light from
    /// the last surface to the film, mm.
    float front_reach() const { return front_reach_; }
    float rear_reach() const { return rear_reach_; }

private:
    /// Rows and columns of points in the rear plane to which rays are traced from each cell of the film.
    static constexpr int kFew = 8, kMany = 10;

    struct Rectangle {
        Vec2f low, high;
    };
    using Rears = std::array<Rectangle, kGhostCells>;

    template <int kRows>
    std::vector<FreeFoundRay> traced(const LensSystem& lens, const std::vector<Crossing>& way,
                                     const Rears& rears) const;

    /// Bounds of the rays found in each cell and its neighbours; those of `before` if there are no rays.
    static Rears around(const std::vector<FreeFoundRay>& rays, const Rears& before);

    LensSystem lens_;
    PathEnds to_scene_;
    FilmSurface<float> film_;
    GhostGrid film_grid_;
    float cell_size_, film_index_;
    float front_reach_, rear_reach_;
    const PupilTracer& tracer_;
};

/// Grid that covers the directions of all these rays.
GhostGrid grid_of_directions(const std::vector<std::vector<FreeFoundRay>>& rays);

double etendue_of(const std::vector<FreeFoundRay>& rays);

}  // namespace REALCAM_NAMESPACE
