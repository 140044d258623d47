#pragma once
#include "../../math/lanes.hpp"

namespace REALCAM_NAMESPACE {

// The film maps over which a pupil is tabulated: RadialFilmMap, over the film radius, and PlanarFilmMap, over the
// film's x and y. A map consists of cells. Nodes, at corners of cells, hold the bounding boxes of the regions of
// passing directions, which are interpolated between nodes. A map provides
//   kHalves                     number of halves of a region that are stored; 1: the region is symmetric in m
//   Node                        type of a node: centre_l, centre_m, half_width and half_height of the box, in optical
//                               direction cosines
//   Frame                       transform between the directions at a film point and those of the map
//   locate(film_x, film_y)      position of a film point (mm) on the map
//   interpolated(nodes, at)     box at a position between nodes
//   node_count(), cell_count()  sizes of the tables

/// Position between nodes.
struct NodePosition {
    int first;  ///< index of the node before the position, in all dimensions
    float x, y;  ///< position from that node, in units of the distance between nodes; one-dimensional maps ignore y
};

/// Position of a film point on a film map.
template <class Map>
struct FilmMapPosition {
    NodePosition nodes;
    int cell;  ///< index of the cell
    typename Map::Frame frame;
    float lit;  ///< 0 if the film point lies outside the map, where no light arrives, else 1
};

/// Box of a region that is symmetric in m.
struct SymmetricPupilNode {
    float centre_l, half_width, half_height;
    static constexpr float centre_m = 0;
};

/// Interpolates two boxes linearly.
REALCAM_INLINE SymmetricPupilNode between(const SymmetricPupilNode& a, const SymmetricPupilNode& b, float f) {
    return {a.centre_l + f * (b.centre_l - a.centre_l), a.half_width + f * (b.half_width - a.half_width),
            a.half_height + f * (b.half_height - a.half_height)};
}

/// Box of a region of any shape.
struct PupilNode {
    float centre_l, centre_m, half_width, half_height;
};

/// Interpolates two boxes linearly.
REALCAM_INLINE PupilNode between(const PupilNode& a, const PupilNode& b, float f) {
    return {a.centre_l + f * (b.centre_l - a.centre_l), a.centre_m + f * (b.centre_m - a.centre_m),
            a.half_width + f * (b.half_width - a.half_width), a.half_height + f * (b.half_height - a.half_height)};
}

/// Film map of a rotationally symmetric lens. Directions of the map are those at a film point on the +x axis. A film
/// radius lies at the position rows * (1 - sqrt(1 - radius / image_radius)), so that the spacing of rows decreases
/// towards the edge, where vignetting changes the region fastest. Each row is a cell, with nodes at its two ends.
struct RadialFilmMap {
    static constexpr int kHalves = 1;
    using Node = SymmetricPupilNode;

    /// Rotation by the film point's azimuth.
    struct Frame {
        float cos, sin;

        REALCAM_INLINE Vec2f to_film(Vec2f d) const { return {d.x * cos - d.y * sin, d.x * sin + d.y * cos}; }
        REALCAM_INLINE Vec2f to_map(Vec2f d) const { return {d.x * cos + d.y * sin, d.y * cos - d.x * sin}; }
    };

    int rows;
    float image_radius;  ///< radius of the image circle, mm: no light reaches film points further out
    float inverse_image_radius;  ///< 0 if the image radius is 0

    REALCAM_INLINE FilmMapPosition<RadialFilmMap> locate(float film_x, float film_y) const {
        const float squared = film_x * film_x + film_y * film_y;
        const bool off_axis = squared > 0.0f;
        const float radius = sqrt_or_zero(squared);
        const float inverse = quotient(1.0f, select(off_axis, radius, 1.0f));
        const float position = static_cast<float>(rows) * (1.0f - sqrt_or_zero(1.0f - radius * inverse_image_radius));
        int row = static_cast<int>(position);
        row = select(row < rows, row, rows - 1);
        return {{row, position - static_cast<float>(row), 0.0f},
                row,
                {select(off_axis, film_x * inverse, 1.0f), film_y * inverse},
                select(radius < image_radius, 1.0f, 0.0f)};
    }

    REALCAM_INLINE Node interpolated(const Node* nodes, const NodePosition& at) const {
        return between(nodes[at.first], nodes[at.first + 1], at.x);
    }

    REALCAM_INLINE int node_count() const { return rows + 1; }
    REALCAM_INLINE int cell_count() const { return rows; }
};

/// Film map of any lens: a grid of cells over a rectangle of the film, with nodes at the corners of every 2 x 2 cells.
/// If the lens has a mirror symmetry, the grid covers one half of the film.
struct PlanarFilmMap {
    static constexpr int kHalves = 2;
    static constexpr int kCellsPerNode = 2;  ///< number of cells between two nodes, in each direction
    using Node = PupilNode;

    /// Mirror images of the map in x and y.
    struct Frame {
        float sign_l, sign_m;  ///< -1: the region is mirrored in l (or m)

        REALCAM_INLINE Vec2f to_film(Vec2f d) const { return {sign_l * d.x, sign_m * d.y}; }
        REALCAM_INLINE Vec2f to_map(Vec2f d) const { return to_film(d); }
    };

    int columns, rows;  ///< numbers of cells, even
    Vec2f corner;  ///< corner of the grid with the smallest x and y, mm
    Vec2f cells_per_mm;
    bool mirrors_x, mirrors_y;  ///< true: the region at -x (or -y) is the mirror image of the one at x (or y)

    /// Points outside the grid use the nearest point of its edge.
    REALCAM_INLINE FilmMapPosition<PlanarFilmMap> locate(float film_x, float film_y) const {
        const auto clamp = [](float position, int cells) {
            const float last = static_cast<float>(cells);
            return select(position > 0.0f, select(position < last, position, last), 0.0f);
        };
        const bool left = mirrors_x & (film_x < 0.0f), below = mirrors_y & (film_y < 0.0f);
        const float x = clamp((select(left, -film_x, film_x) - corner.x) * cells_per_mm.x, columns);
        const float y = clamp((select(below, -film_y, film_y) - corner.y) * cells_per_mm.y, rows);
        int column = static_cast<int>(x), row = static_cast<int>(y);
        column = select(column < columns, column, columns - 1);
        row = select(row < rows, row, rows - 1);
        const int node_column = column / kCellsPerNode, node_row = row / kCellsPerNode;
        return {{node_row * node_columns() + node_column, x / kCellsPerNode - static_cast<float>(node_column),
                 y / kCellsPerNode - static_cast<float>(node_row)},
                row * columns + column,
                {select(left, -1.0f, 1.0f), select(below, -1.0f, 1.0f)},
                1.0f};
    }

    REALCAM_INLINE Node interpolated(const Node* nodes, const NodePosition& at) const {
        const Node *const near = nodes + at.first, *const far = near + node_columns();
        return between(between(near[0], near[1], at.x), between(far[0], far[1], at.x), at.y);
    }

    REALCAM_INLINE int node_columns() const { return columns / kCellsPerNode + 1; }
    REALCAM_INLINE int node_rows() const { return rows / kCellsPerNode + 1; }
    REALCAM_INLINE int node_count() const { return node_columns() * node_rows(); }
    REALCAM_INLINE int cell_count() const { return columns * rows; }
};

}  // namespace REALCAM_NAMESPACE
