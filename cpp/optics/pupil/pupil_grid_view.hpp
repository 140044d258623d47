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
    const PupilGridNode* nodes;  ///< at the corners of each 2 x 2 cells, row by row; null: a PupilView is used instead
    const PupilGridCell* cells;  ///< columns x rows
    const PupilSector* sectors;  ///< 2 x kPupilGridSectors for each cell
    int columns, rows;  ///< even
    Vec2f corner;  ///< corner of the grid with the smallest x and y, mm
    Vec2f cells_per_mm;
    bool mirrors_x, mirrors_y;  ///< the region at x < 0, or y < 0, is the mirror image of the one beyond 0
    float index_squared;  ///< n^2 of the medium before the film
};

inline constexpr int kPupilGridSectors = 32;  ///< sectors of half a region

inline constexpr int kCellsPerPupilNode = 2;

/// Lookup of a film point: its cell, and the interpolated box of its region.
struct PupilGridLookup {
    PupilGridNode box;
    int cell;
    float sign_l, sign_m;  ///< -1: the region is mirrored
};

REALCAM_INLINE PupilGridLookup pupil_grid_lookup(const PupilGridView& pupil, float film_x, float film_y) {
    // Film points outside the grid use its edge.
    const auto within = [](float place, int cells) {
        const float last = static_cast<float>(cells);
        return select(place > 0.0f, select(place < last, place, last), 0.0f);
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
REALCAM_INLINE float pupil_weight(const PupilGridLookup& place, const PupilGridCell& cell, const PupilSector& sector,
                                  bool lower) {
    const float area = (sector.x * sector.dy - sector.y * sector.dx) * (1.0f - sector.hole_squared);
    return select(lower, cell.lower_weight, cell.upper_weight) * area * place.box.half_width * place.box.half_height;
}

/// Samples a direction for a film point (x, y) in mm, from u and v in [0, 1). Uniform over each sector of the cell.
REALCAM_INLINE PupilSample sample_pupil(const PupilGridView& pupil, float film_x, float film_y, float u, float v) {
    const PupilGridLookup place = pupil_grid_lookup(pupil, film_x, film_y);
    const PupilGridCell cell = pupil.cells[place.cell];
    const bool lower = u >= cell.upper_share;
    const float share = select(lower, 1.0f - cell.upper_share, cell.upper_share);
    const float in_half = quotient(select(lower, u - cell.upper_share, u), share);
    const float scaled = in_half * static_cast<float>(kPupilGridSectors);
    int index = static_cast<int>(scaled);
    index = select(index < kPupilGridSectors, index, kPupilGridSectors - 1);
    const float along = scaled - static_cast<float>(index);
    const PupilSector& sector = pupil.sectors[(2 * place.cell + select(lower, 1, 0)) * kPupilGridSectors + index];
    const float reach = sqrt_or_zero(sector.hole_squared + v * (1.0f - sector.hole_squared));
    const float x = reach * (sector.x + along * sector.dx);
    const float y = reach * (sector.y + along * sector.dy);
    const float l = place.box.centre_l + place.box.half_width * x;
    const float m = place.box.centre_m + place.box.half_height * select(lower, -y, y);
    const float rest = pupil.index_squared - l * l - m * m;
    return {{place.sign_l * l, place.sign_m * m, -sqrt_or_zero(rest)},
            select(rest > 0.0f, pupil_weight(place, cell, sector, lower), 0.0f)};
}

/// Density of sample_pupil at the optical direction cosines (l, m), per unit of their area.
REALCAM_INLINE float pupil_pdf(const PupilGridView& pupil, float film_x, float film_y, float l, float m) {
    const PupilGridLookup place = pupil_grid_lookup(pupil, film_x, film_y);
    const float x = (place.sign_l * l - place.box.centre_l) / place.box.half_width;
    const float signed_y = (place.sign_m * m - place.box.centre_m) / place.box.half_height;
    const bool lower = signed_y < 0.0f;
    const float y = std::fabs(signed_y);
    const PupilSector* const half = pupil.sectors + (2 * place.cell + select(lower, 1, 0)) * kPupilGridSectors;
    const PupilSector& s = half[sector_at(half, kPupilGridSectors, x, y)];
    const float weight = pupil_weight(place, pupil.cells[place.cell], s, lower);
    return select(holds(s, x, y) && l * l + m * m < pupil.index_squared && weight > 0.0f, 1.0f / weight, 0.0f);
}

}  // namespace REALCAM_NAMESPACE
