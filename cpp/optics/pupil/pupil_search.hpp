#pragma once
#include <optional>
#include <utility>
#include <vector>

#include "direction_box.hpp"
#include "pupil_lens.hpp"

namespace REALCAM_NAMESPACE {

/// Finds the region of directions in which rays from a film point pass a lens: its bounding box, by tracing grids of
/// real rays.
class PupilSearch {
public:
    static constexpr int kBlock = PupilTracer::kBlock;
    /// Upper bound of the number of ray blocks that one call of find traces: for each of two searches, six levels of 11
    /// blocks, 5 more blocks, and 17 extensions of 6 blocks.
    static constexpr int kMaxBlocks = 2 * (6 * 11 + 5 + 17 * 6);

    PupilSearch(const LensSystem& lens, FilmMap film_map, PupilTracer tracer,
                const std::vector<double>& wavelengths_nm = {})
        : lens_(lens, std::move(tracer), wavelengths_nm), film_map_(film_map) {}

    const PupilLens& lens() const { return lens_; }

    /// Returns the bounding box of the passing directions of a film point (mm), or std::nullopt if no light reaches it.
    /// `expected`: box near which to search first, such as that of a neighbouring film point.
    std::optional<DirectionBox> find(Vec2<double> film, const std::optional<DirectionBox>& expected) const;

    /// Same as find, but searches only near the expected box.
    std::optional<DirectionBox> find_near(Vec2<double> film, const DirectionBox& expected) const;

private:
    /// Grid of directions over a box: l by column, and m by row. A symmetric region (FilmMap::radial) is searched only
    /// for m >= 0, and with more columns, because at the edge of the image it is a thin crescent.
    struct Grid {
        /// `part`: the box, or its upper half for a symmetric region.
        Grid(FilmMap film_map, const DirectionBox& part);

        int points() const { return columns * rows; }
        PupilDirection direction(int point) const { return {l[point % columns], m[point / columns]}; }

        int columns, rows;
        double l[48], m[32];
        double step_l, step_m;  ///< distances between neighbouring directions
    };
    static constexpr int kMaxPoints = 48 * 24, kMaxGridBlocks = (kMaxPoints + kBlock - 1) / kBlock;

    /// Summary of the rays of a grid that pass the lens.
    struct PassingRays {
        int count = 0;
        DirectionBox box = DirectionBox::empty();  ///< bounding box of their directions
        PupilDirection highest{0, 0};  ///< midpoint of the passing directions in the highest row
    };

    /// True if regions are symmetric in m, so that only their upper half is searched.
    bool is_symmetric() const { return film_map_ == FilmMap::radial; }
    /// Returns the grid over the gridded part of a box.
    Grid grid_over(const DirectionBox& box) const { return Grid(film_map_, gridded_part(box)); }

    /// Returns the part of a box that a grid covers: the upper half for a symmetric region, otherwise the whole box.
    DirectionBox gridded_part(const DirectionBox& box) const {
        return {box.l_min, box.l_max, is_symmetric() ? 0 : box.m_min, box.m_max};
    }
    /// Returns the whole box of a gridded part: the inverse of gridded_part.
    DirectionBox whole_box(const DirectionBox& part) const {
        return {part.l_min, part.l_max, is_symmetric() ? -part.m_max : part.m_min, part.m_max};
    }
    /// Returns the box with its sides moved outwards by a fraction of the width and height of its gridded part.
    DirectionBox enlarged(const DirectionBox& box, double fraction) const;

    /// Calls `trace`(rays, index of the first point) for each block of a grid, in any order and on any threads.
    template <class Trace>
    void trace_grid(Vec2<double> film, const Grid& grid, Trace&& trace) const;

    /// Traces a grid over the box `search`.
    PassingRays trace_grid_over(Vec2<double> film, const DirectionBox& search) const;

    /// Refines the box of the passing rays of a grid over `search`; the region extends beyond it by less than a grid
    /// step. A symmetric region is widest along l at m = 0: more rays locate its edges there. Other regions may be
    /// widest anywhere: a whole step is added on each side.
    DirectionBox refined(Vec2<double> film, const DirectionBox& search, const PassingRays& passing) const;

    /// Returns the box of all directions to the clear aperture of the last surface, with a margin.
    DirectionBox widest_box(Vec2<double> film) const;

    /// Finds the box of the passing directions in `search`; std::nullopt if there are none. A small aperture may fall
    /// between the points of a grid. So if too few rays pass, the search continues with a smaller box around those that
    /// pass, or around the ray that comes nearest to the centre of the stop. `widest`: see widest_box.
    std::optional<DirectionBox> find_box(Vec2<double> film, DirectionBox search, const DirectionBox& widest) const;

    /// Extends a box that was found in `search` to the whole region of passing directions. This is necessary because
    /// `search` may contain only a part of it: an edge, if the region has moved by more than its size, or the middle,
    /// if it was found around the ray nearest to the centre of the stop.
    DirectionBox extended_to_region(Vec2<double> film, DirectionBox box, DirectionBox search,
                                    const DirectionBox& widest) const;

    /// Ray of a grid that comes nearest to the centre of the stop.
    struct NearestRay {
        PupilDirection direction;
        double distance;  ///< distance from the centre of the stop, in units of the stop's radius
        bool all_in_stop;  ///< true if all rays of the grid pass the opening of the stop
    };
    /// Returns std::nullopt if no ray of the grid over `search` reaches the plane of the stop.
    std::optional<NearestRay> nearest_to_stop(Vec2<double> film, const DirectionBox& search) const;

    /// True if a finer grid around `nearest` would find no light either, given that no ray of its own grid passes the
    /// lens: all rays of the grid pass the stop, so that a rim blocks them, or the grid came no nearer to the centre of
    /// the stop than `last`, the result of the previous, coarser grid (if there was one).
    static bool is_dark_around(const NearestRay& nearest, const std::optional<NearestRay>& last);

    PupilLens lens_;
    FilmMap film_map_;
};

}  // namespace REALCAM_NAMESPACE
