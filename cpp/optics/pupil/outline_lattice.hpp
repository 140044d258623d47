#pragma once
#include <cstddef>
#include <vector>

#include "film_points.hpp"
#include "pupil_outline.hpp"

namespace REALCAM_NAMESPACE {

/// Outlines of regions at the points of a regular lattice over a film map, as far as they have been found.
class OutlineLattice {
public:
    /// Lattice point.
    struct Point {
        int column, row;
    };

    /// `columns`, `rows`: numbers of points; `halves`: number of outlines of each (kHalves of the film map); `spacing`:
    /// distance of neighbouring points in units of cells.
    OutlineLattice(int columns, int rows, int halves, double spacing);

    /// Position of a point on the film map.
    CellPosition position(Point point) const { return {spacing_ * point.column, spacing_ * point.row}; }

    /// Points whose column and row are multiples of `step`, row by row.
    std::vector<Point> points(int step = 1) const;
    /// Points of points(step) that lie midway between points(2 step).
    std::vector<Point> midway_points(int step) const;
    /// Points whose outlines have been found.
    std::vector<Point> found_points() const;

    /// True if the outlines of a point have been found.
    bool has(Point point) const { return slot(point) >= 0; }
    /// Outlines of points that have been found, all halves of each point in succession.
    std::vector<PupilOutline> outlines(const std::vector<Point>& points) const;
    /// Expected outlines of points of midway_points(step): means of their neighbours' outlines.
    std::vector<PupilOutline> expected(const std::vector<Point>& midway, int step) const;
    /// Outlines of half a region that have been found in a cell and on its edges.
    std::vector<PupilOutline> outlines_of_cell(int column, int row, int half) const;

    /// Stores outlines, in the order of `outlines`.
    void store(const std::vector<Point>& points, const std::vector<PupilOutline>& found);

private:
    int& slot(Point point) { return slots_[static_cast<std::size_t>(point.row * columns_ + point.column)]; }
    int slot(Point point) const { return slots_[static_cast<std::size_t>(point.row * columns_ + point.column)]; }
    /// Outline of a point that has been found.
    const PupilOutline& outline(Point point, int half) const {
        return outlines_[static_cast<std::size_t>(slot(point) + half)];
    }

    int columns_, rows_, halves_;
    double spacing_;
    std::vector<int> slots_;  ///< index of each point's first outline in outlines_; -1: not found
    std::vector<PupilOutline> outlines_;
};

}  // namespace REALCAM_NAMESPACE
