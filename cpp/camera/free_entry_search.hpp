#pragma once
#include <array>
#include <vector>

#include "../optics/pupil/film_surface.hpp"
#include "../optics/pupil/pupil_tracer.hpp"
#include "../optics/trace/film_frame.hpp"
#include "ghost_view.hpp"

namespace REALCAM_NAMESPACE {

/// A ray from the film of a lens of any kind that has left the lens by some way.
struct FreeFoundRay {
    Vec2f half_tangents;  ///< of its direction
    Vec2f front;  ///< place across it through the origin of the camera's frame (light_axes), mm
    int film_cell;  ///< of the grid over the film, in which it began
    Vec2f rear;  ///< place in the plane z = 0 of the film's frame, mm
    Vec2f rear_step;  ///< by which its neighbours lie beside it there
    float etendue;  ///< mm^2 sr
};

/// EntrySearch for lenses that are not of revolution: by rays back from a grid over the film to a plane in front of it.
class FreeEntrySearch {
public:
    using Found = FreeFoundRay;

    /// `film_radius`: of a circle about the vertex of the film that holds the film, mm.
    FreeEntrySearch(const LensSystem& lens, double film_radius, const PupilTracer& tracer);

    /// `way`: of light to the film; `lens`: to whose surfaces it belongs.
    std::vector<FreeFoundRay> along(const LensSystem& lens, const std::vector<Crossing>& way) const;

    /// Where light of a way comes in at the front, in cells of the grid of directions; and at the film, in cells of
    /// that.
    static std::vector<FreeGhostEntry> entries_of(const std::vector<FreeFoundRay>& rays, const GhostGrid& directions);
    static std::vector<FreeGhostEntry> exits_of(const std::vector<FreeFoundRay>& rays);

    const GhostGrid& film_grid() const { return film_grid_; }
    /// Radius of a circle about the origin, across light from anywhere, that holds all that meets the front surface;
    /// and of one in the plane z = 0 of the film's frame that holds all light from the last surface to the film, mm.
    float front_reach() const { return front_reach_; }
    float rear_reach() const { return rear_reach_; }

private:
    /// Rows of places in the rear plane to which rays go from each cell of the film, and columns likewise.
    static constexpr int kFew = 8, kMany = 10;

    struct Rectangle {
        Vec2f low, high;
    };
    using Rears = std::array<Rectangle, kGhostCells>;

    template <int kRows>
    std::vector<FreeFoundRay> traced(const LensSystem& lens, const std::vector<Crossing>& way,
                                     const Rears& rears) const;

    /// About the rays that were found in each cell or beside it; where there are none, as before.
    static Rears around(const std::vector<FreeFoundRay>& rays, const Rears& before);

    LensSystem lens_;
    PathEnds to_scene_;
    FilmSurface<float> film_;
    GhostGrid film_grid_;
    float cell_size_, film_index_;
    float front_reach_, rear_reach_;
    const PupilTracer& tracer_;
};

/// A grid that holds the directions of all these rays.
GhostGrid grid_of_directions(const std::vector<std::vector<FreeFoundRay>>& rays);

double etendue_of(const std::vector<FreeFoundRay>& rays);

}  // namespace REALCAM_NAMESPACE
