#pragma once
#include "pupil_view.hpp"

namespace REALCAM_NAMESPACE {

// Pupil of a lens without rotational symmetry, tabulated over the film's x and y. See pupil_view.hpp for the terms and
// for sample_pupil and pupil_pdf. For each cell of a grid over the film, the region of passing directions is a list of
// sectors, half of them above the centre of its box and half below.

/// Bounding box of the region of passing directions of a film point, in optical direction cosines.
struct PupilGridNode {
    float centre_l, centre_m;
    float half_width, half_height;
};

/// Cell of the film. The sectors of the upper half (m above the centre of the box) precede those of the lower half,
/// whose y points down.
struct PupilGridCell {
    float upper_probability;   ///< probability of sampling the upper half: its fraction of the region's area
    float upper_weight, lower_weight;  ///< 1 / (2 x probability of choosing a sector); 0 in a dark cell
};

/// Table of the pupil over a grid of cells.
struct PupilGridView {
    static constexpr int kSectors = PupilView::kSectors;  ///< sectors of half a region

    const PupilGridNode* nodes;  ///< at the corners of every 2 x 2 cells, row by row; null: a PupilView is used instead
    const PupilGridCell* cells;  ///< columns x rows
    const PupilSector* outline;  ///< 2 x kSectors for each cell
    int columns, rows;  ///< numbers of cells, even
    Vec2f corner;  ///< corner of the grid with the smallest x and y, mm
    Vec2f cells_per_mm;
    bool mirrors_x, mirrors_y;  ///< true: the region at -x (or -y) is the mirror image of the one at x (or y)
    float index_squared;  ///< n^2 of the medium in front of the film
};

/// Number of cells between two nodes, in each direction.
inline constexpr int kCellsPerPupilNode = 2;

/// Entry of a PupilGridView for a film point: its cell, and the interpolated box of its region.
struct PupilGridLookup {
    PupilGridNode box;
    int cell;  ///< index of the cell
    float sign_l, sign_m;  ///< -1: the region is mirrored in l (or m)

    /// Chooses a half by its probability and one of its sectors with equal probability, by a random number u in [0, 1).
    REALCAM_INLINE PupilSectorDraw draw(const PupilGridView& pupil, float u) const {
        constexpr int kSectors = PupilGridView::kSectors;
        const float upper_probability = pupil.cells[cell].upper_probability;
        const bool lower = u >= upper_probability;
        const float in_half = quotient(select(lower, u - upper_probability, u),
                                       select(lower, 1.0f - upper_probability, upper_probability));
        const float scaled = in_half * static_cast<float>(kSectors);
        int index = static_cast<int>(scaled);
        index = select(index < kSectors, index, kSectors - 1);
        return {half(pupil, lower) + index, scaled - static_cast<float>(index), select(lower, 1, 0)};
    }
    /// Index of the first sector of a half.
    REALCAM_INLINE int half(const PupilGridView&, bool lower) const {
        return (2 * cell + select(lower, 1, 0)) * PupilGridView::kSectors;
    }
    /// Converts a point in the box, in units of its half-widths, to direction cosines of the map (not mirrored).
    REALCAM_INLINE Vec2f from_box(Vec2f point) const {
        return {box.centre_l + box.half_width * point.x, box.centre_m + box.half_height * point.y};
    }
    /// Converts direction cosines of the map to those at the film point.
    REALCAM_INLINE Vec2f to_film(Vec2f d) const { return {sign_l * d.x, sign_m * d.y}; }
    /// Converts direction cosines at the film point to a point in the box, in units of its half-widths.
    REALCAM_INLINE Vec2f in_box(Vec2f film) const {
        return {(sign_l * film.x - box.centre_l) / box.half_width, (sign_m * film.y - box.centre_m) / box.half_height};
    }
};

/// Looks up a film point (mm). Points outside the grid use the nearest point of its edge.
REALCAM_INLINE PupilGridLookup pupil_lookup(const PupilGridView& pupil, float film_x, float film_y) {
    const auto clamp = [](float position, int cells) {
        const float last = static_cast<float>(cells);
        return select(position > 0.0f, select(position < last, position, last), 0.0f);
    };
    const bool left = pupil.mirrors_x & (film_x < 0.0f), below = pupil.mirrors_y & (film_y < 0.0f);
    const float x = clamp((select(left, -film_x, film_x) - pupil.corner.x) * pupil.cells_per_mm.x, pupil.columns);
    const float y = clamp((select(below, -film_y, film_y) - pupil.corner.y) * pupil.cells_per_mm.y, pupil.rows);
    int column = static_cast<int>(x), row = static_cast<int>(y);
    column = select(column < pupil.columns, column, pupil.columns - 1);
    row = select(row < pupil.rows, row, pupil.rows - 1);
    const int node_column = column / kCellsPerPupilNode, node_row = row / kCellsPerPupilNode;
    const int node_columns = pupil.columns / kCellsPerPupilNode + 1;
    const float fx = x / kCellsPerPupilNode - static_cast<float>(node_column);
    const float fy = y / kCellsPerPupilNode - static_cast<float>(node_row);
    const PupilGridNode* const near = pupil.nodes + node_row * node_columns + node_column;
    const PupilGridNode* const far = near + node_columns;
    const auto between = [&](float PupilGridNode::* member) {
        const float a = near[0].*member + fx * (near[1].*member - near[0].*member);
        const float b = far[0].*member + fx * (far[1].*member - far[0].*member);
        return a + fy * (b - a);
    };
    return {{between(&PupilGridNode::centre_l), between(&PupilGridNode::centre_m), between(&PupilGridNode::half_width),
             between(&PupilGridNode::half_height)},
            row * pupil.columns + column,
            select(left, -1.0f, 1.0f),
            select(below, -1.0f, 1.0f)};
}

/// Inverse density of directions in a sector, an area in direction cosines; 0 in a dark cell.
REALCAM_INLINE float pupil_weight(const PupilGridView& pupil, const PupilGridLookup& lookup, const PupilSector& sector,
                                  bool lower) {
    const PupilGridCell& cell = pupil.cells[lookup.cell];
    return select(lower, cell.lower_weight, cell.upper_weight) * twice_area(sector) * lookup.box.half_width *
           lookup.box.half_height;
}

/// False if no light can reach a film point.
REALCAM_INLINE bool may_be_lit(const PupilGridView& pupil, const PupilGridLookup& lookup) {
    return pupil.cells[lookup.cell].upper_weight > 0.0f;
}

}  // namespace REALCAM_NAMESPACE
