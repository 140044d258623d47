#pragma once
#include <optional>
#include <utility>
#include <vector>

#include "direction_box.hpp"
#include "pupil_lens.hpp"

namespace REALCAM_NAMESPACE {

/// Finds, by tracing real rays, the bounding box of the directions that pass a lens from a film point.
class PupilSearch {
public:
    static constexpr int kBlock = PupilTracer::kBlock;
    /// Upper bound of the number of ray blocks of one search: two searches of six levels, 11 blocks each, of 5 more,
    /// and of 17 extensions.
    static constexpr int kMostBlocks = 2 * (6 * 11 + 5 + 17 * 6);

    PupilSearch(const LensSystem& lens, FilmMap film_map, PupilTracer tracer,
                const std::vector<double>& wavelengths_nm = {})
        : lens_(lens, std::move(tracer), wavelengths_nm), film_map_(film_map) {}

    const PupilLens& lens() const { return lens_; }

    /// Returns std::nullopt if no light arrives. `expected`: box near which the search begins.
    std::optional<DirectionBox> look(Vec2<double> film, const std::optional<DirectionBox>& expected) const;

    /// Same as look, but searches only near the expected box.
    std::optional<DirectionBox> look_near(Vec2<double> film, const DirectionBox& expected) const;

private:
    /// Grid of directions over a box: their l by column, and their m by row. A symmetric region is searched for m >= 0
    /// only, and with more columns, because it is a thin crescent at the edge of the image.
    struct Grid {
        Grid(FilmMap film_map, const DirectionBox& part);

        int points() const { return columns * rows; }
        PupilDirection direction(int point) const { return {l[point % columns], m[point / columns]}; }

        int columns, rows;
        double l[48], m[32];
        double cell_l, cell_m;  ///< distances of neighbouring directions
    };
    static constexpr int kMostPoints = 48 * 24, kMostGridBlocks = (kMostPoints + kBlock - 1) / kBlock;

    /// Passing rays of a grid.
    struct Passing {
        int count = 0;
        DirectionBox box = DirectionBox::none();
        PupilDirection highest{0, 0};  ///< centre of the top row's passing points
    };

    bool is_symmetric() const { return film_map_ == FilmMap::radial; }
    Grid grid_over(const DirectionBox& box) const { return Grid(film_map_, searched(box)); }

    /// The part of a box that the grid covers: of a symmetric box, the upper half.
    DirectionBox searched(const DirectionBox& box) const {
        return {box.l_min, box.l_max, is_symmetric() ? 0 : box.m_min, box.m_max};
    }
    /// The box of which this is the searched part.
    DirectionBox whole_of(const DirectionBox& part) const {
        return {part.l_min, part.l_max, is_symmetric() ? -part.m_max : part.m_min, part.m_max};
    }
    /// Grows each side by these shares of the searched part's width and height.
    DirectionBox grown(const DirectionBox& box, double share) const;

    /// Calls `trace`(rays, index of the first point) for each block of a grid, in any order and on any threads.
    template <class Trace>
    void trace_grid(Vec2<double> film, const Grid& grid, Trace&& trace) const;

    Passing passing(Vec2<double> film, const DirectionBox& search) const;

    /// Bounding box of the passing directions of a grid: extends the box of its passing points, outside which light
    /// reaches less than a cell further. The edges of a symmetric region, which is widest along l at m = 0, are located
    /// by more rays; other regions may be widest anywhere, so that a whole cell is added on each side.
    DirectionBox refined(Vec2<double> film, const DirectionBox& search, const Passing& seen) const;

    DirectionBox widest_box(Vec2<double> film) const;

    /// A small aperture may fall between the points of any grid: if too few rays pass, searches a smaller box around
    /// those that pass, or around the ray that comes nearest to the centre of the stop.
    std::optional<DirectionBox> find_box(Vec2<double> film, DirectionBox search, const DirectionBox& widest) const;

    /// Extends a box to the whole region, because the searched box may have contained only a part: a sliver of a region
    /// that has moved by more than its size, or the middle of one that was found by its nearest ray.
    DirectionBox whole(Vec2<double> film, DirectionBox box, DirectionBox search, const DirectionBox& widest) const;

    /// The ray of a grid that comes nearest to the centre of the stop.
    struct NearestRay {
        PupilDirection at;
        double distance;  ///< from the centre of the stop, in units of the stop's radius
        bool all_in_stop;  ///< true if the whole grid passes the opening of the stop
    };
    std::optional<NearestRay> nearest_to_stop(Vec2<double> film, const DirectionBox& search) const;

    /// True if a finer grid around `nearest` will show no light, its own grid being dark: either its whole grid passes
    /// the stop and is blocked by a rim, or its grid came no nearer than `last`, the result of the previous, coarser
    /// grid if there was one.
    static bool is_dark_around(const NearestRay& nearest, const std::optional<NearestRay>& last);

    PupilLens lens_;
    FilmMap film_map_;
};

}  // namespace REALCAM_NAMESPACE
