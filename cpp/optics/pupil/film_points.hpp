#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "../../math/random.hpp"
#include "film_symmetry.hpp"
#include "pupil_tracer.hpp"
#include "pupil_view.hpp"

namespace REALCAM_NAMESPACE {

// Film points of the cells of a film map, for the search for a pupil. RadialFilmPoints and PlanarFilmPoints provide
//   Map, map()         the film map, for sampling
//   columns, rows      numbers of cells in both dimensions
//   film_point(at)     film point (mm) at a position
//   nodes_at(at)       its position between nodes
//   stray_points(...)  random film points of a round of StraySearch in a cell, by the index of the ray
//   kStrayRounds, kStrayDimension  StraySearch::max_rounds and StraySearch::dimension

/// Position on a film map in units of cells; one-dimensional maps use x alone.
using CellPosition = Vec2<double>;

/// Film point at which a ray of StraySearch begins.
struct StrayPoint {
    Vec2<double> film;  ///< mm
    NodePosition nodes;
};

/// Film points on the +x axis. Columns are the rows of a RadialFilmMap.
struct RadialFilmPoints {
    using Map = RadialFilmMap;
    static constexpr int columns = 48, rows = 1;
    static constexpr int kStrayRounds = 256, kStrayDimension = 0;

    double image_radius;  ///< film radius of the last node, mm

    /// Image radius rounded up, so that the last lit film point does not fall outside.
    Map map() const {
        const float radius = image_radius > 0 ? std::nextafter(static_cast<float>(image_radius), 1e30f) : 0.0f;
        return {columns, radius, radius > 0 ? 1 / radius : 0.0f};
    }
    /// Film radius at a position, mm.
    double radius_at(double position) const {
        const double inward = 1 - position / columns;
        return image_radius * (1 - inward * inward);
    }
    Vec2<double> film_point(CellPosition at) const { return {radius_at(at.x), 0}; }
    NodePosition nodes_at(CellPosition at) const {
        const int column = std::min(static_cast<int>(at.x), columns - 1);
        return {column, static_cast<float>(at.x - column), 0};
    }
    /// All rays of a round begin at one point: in the first rounds at the outer and at the inner end of the cell, then
    /// at random radii.
    auto stray_points(int column, int, int round, std::uint32_t stream) const {
        constexpr double kOuterEnd = 0.9999;
        const double position = column + (round < 2   ? kOuterEnd
                                          : round < 4 ? 0.0
                                                      : static_cast<double>(sample_2d(stream, 0, 1).x));
        const StrayPoint point = {film_point({position, 0}), nodes_at({position, 0})};
        return [point](int) { return point; };
    }
};

/// Film points of a rectangle.
struct PlanarFilmPoints {
    using Map = PlanarFilmMap;
    static constexpr int kStrayRounds = 128, kStrayDimension = 1;  // dimension 0 chooses the film points

    FilmArea film;  ///< the part of the film that the map covers
    MirrorPlanes planes;
    int columns = 24, rows = 16;  ///< halved by a mirror symmetry

    /// `area`: rectangle that contains all film points.
    PlanarFilmPoints(const FilmArea& area, MirrorPlanes symmetries) : film(area), planes(symmetries) {
        const auto restrict_to_half = [](double& low, double& high, int& cells) {
            high = std::max(std::fabs(low), std::fabs(high));
            low = 0;
            cells /= 2;
        };
        if (planes.x) restrict_to_half(film.least.x, film.most.x, columns);
        if (planes.y) restrict_to_half(film.least.y, film.most.y, rows);
    }

    Map map() const {
        return {columns,
                rows,
                {static_cast<float>(film.least.x), static_cast<float>(film.least.y)},
                {static_cast<float>(columns / (film.most.x - film.least.x)),
                 static_cast<float>(rows / (film.most.y - film.least.y))},
                planes.x,
                planes.y};
    }
    Vec2<double> film_point(CellPosition at) const {
        return {film.least.x + at.x / columns * (film.most.x - film.least.x),
                film.least.y + at.y / rows * (film.most.y - film.least.y)};
    }
    NodePosition nodes_at(CellPosition at) const {
        const Vec2<double> point = film_point(at);
        return map().locate(static_cast<float>(point.x), static_cast<float>(point.y)).nodes;
    }
    /// Each ray begins at a random point of the cell.
    auto stray_points(int column, int row, int, std::uint32_t stream) const {
        constexpr int kBlock = PupilTracer::kBlock, kCells = Map::kCellsPerNode;
        Vec2Lanes<float, kBlock> in_cell;
        for (int i = 0; i < kBlock; ++i) in_cell.set(i, sample_2d(stream, static_cast<std::uint32_t>(i), 0));
        const int first = row / kCells * map().node_columns() + column / kCells;
        const float left = static_cast<float>(column % kCells), low = static_cast<float>(row % kCells);
        const Vec2<double> corner = film_point({static_cast<double>(column), static_cast<double>(row)}),
                           opposite = film_point({column + 1.0, row + 1.0});
        return [=](int i) {
            const Vec2f at = in_cell[i];
            return StrayPoint{{corner.x + static_cast<double>(at.x) * (opposite.x - corner.x),
                               corner.y + static_cast<double>(at.y) * (opposite.y - corner.y)},
                              {first, (left + at.x) / kCells, (low + at.y) / kCells}};
        };
    }
};

}  // namespace REALCAM_NAMESPACE
