#pragma once
#include "pupil_view.hpp"

namespace REALCAM_NAMESPACE {

// Pupil of a lens without rotational symmetry, tabulated over film positions instead of radii. In each cell of a grid
// over the film, the outline of the region is a list of triangles, half of them above its centre and half below.

/// Bounding box of the pupil of a film point, in optical direction cosines.
struct PupilGridNode {
    float centre_l, centre_m;
    float half_width, half_height;
};

/// A cell of the film. The sectors of the upper half, m above the box's centre, precede those of the lower half, whose
/// y points down.
struct PupilGridCell {
    float upper_share;   ///< share of the region's area, and probability of sampling the upper half
    float upper_weight, lower_weight;  ///< 1 / (2 x probability of choosing a sector); 0 in a dark cell
};

struct PupilGridView {
    static constexpr int kSectors = PupilView::kSectors;  ///< sectors of half a region

    const PupilGridNode* nodes;  ///< at the corners of each 2 x 2 cells, row by row; null: a PupilView is used instead
    const PupilGridCell* cells;  ///< columns x rows
    const PupilSector* outline;  ///< 2 x kSectors for each cell
    int columns, rows;  ///< even
    Vec2f corner;  ///< corner of the grid with the smallest x and y, mm
    Vec2f cells_per_mm;
    bool mirrors_x, mirrors_y;  ///< the region at x < 0, or y < 0, is the mirror image of the one beyond 0
    float index_squared;  ///< n^2 of the medium before the film
};

inline constexpr int kCellsPerPupilNode = 2;

/// Lookup of a film point: its cell, and the interpolated box of its region.
struct PupilGridLookup {
    PupilGridNode box;
    int cell;
    float sign_l, sign_m;  ///< -1: the region is mirrored

    REALCAM_INLINE PupilSectorDraw draw(const PupilGridView& pupil, float u) const {
        constexpr int kSectors = PupilGridView::kSectors;
        const float upper_share = pupil.cells[cell].upper_share;
        const bool lower = u >= upper_share;
        const float in_half =
            quotient(select(lower, u - upper_share, u), select(lower, 1.0f - upper_share, upper_share));
        const float scaled = in_half * static_cast<float>(kSectors);
        int index = static_cast<int>(scaled);
        index = select(index < kSectors, index, kSectors - 1);
        return {half(pupil, lower) + index, scaled - static_cast<float>(index), select(lower, 1, 0)};
    }
    /// Index of the first sector of a half.
    REALCAM_INLINE int half(const PupilGridView&, bool lower) const {
        return (2 * cell + select(lower, 1, 0)) * PupilGridView::kSectors;
    }
    REALCAM_INLINE Vec2f from_box(Vec2f lookup) const {
        return {box.centre_l + box.half_width * lookup.x, box.centre_m + box.half_height * lookup.y};
    }
    REALCAM_INLINE Vec2f to_film(Vec2f d) const { return {sign_l * d.x, sign_m * d.y}; }
    /// Point in the box, in units of its half-widths, of direction cosines at the film.
    REALCAM_INLINE Vec2f in_box(Vec2f film) const {
        return {(sign_l * film.x - box.centre_l) / box.half_width, (sign_m * film.y - box.centre_m) / box.half_height};
    }
};

REALCAM_INLINE PupilGridLookup pupil_lookup(const PupilGridView& pupil, float film_x, float film_y) {
    // Film points outside the grid use its edge.
    const auto within = [](float position, int cells) {
        const float last = static_cast<float>(cells);
        return select(position > 0.0f, select(position < last, position, last), 0.0f);
    };
    const bool left = pupil.mirrors_x & (film_x < 0.0f), below = pupil.mirrors_y & (film_y < 0.0f);
    const float x = within((select(left, -film_x, film_x) - pupil.corner.x) * pupil.cells_per_mm.x, pupil.columns);
    const float y = within((select(below, -film_y, film_y) - pupil.corner.y) * pupil.cells_per_mm.y, pupil.rows);
    int column = static_cast<int>(x), row = static_cast<int>(y);
    column = select(column < pupil.columns, column, pupil.columns - 1);
    row = select(row < pupil.rows, row, pupil.rows - 1);
    const int node_column = column / kCellsPerPupilNode, node_row = row / kCellsPerPupilNode;
    const int nodes_a_row = pupil.columns / kCellsPerPupilNode + 1;
    const float fx = x / kCellsPerPupilNode - static_cast<float>(node_column);
    const float fy = y / kCellsPerPupilNode - static_cast<float>(node_row);
    const PupilGridNode* const near = pupil.nodes + node_row * nodes_a_row + node_column;
    const PupilGridNode* const far = near + nodes_a_row;
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

/// Inverse density in a sector, steradians of projected solid angle; 0 in a dark cell.
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
