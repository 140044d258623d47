#include "outline_lattice.hpp"

#include <algorithm>

namespace realcam {

OutlineLattice::OutlineLattice(int columns, int rows, int halves, double spacing)
    : columns_(columns),
      rows_(rows),
      halves_(halves),
      spacing_(spacing),
      slots_(static_cast<std::size_t>(columns * rows), -1) {}

std::vector<OutlineLattice::Point> OutlineLattice::points(int step) const {
    std::vector<Point> points;
    for (int row = 0; row < rows_; row += step)
        for (int column = 0; column < columns_; column += step) points.push_back({column, row});
    return points;
}

std::vector<OutlineLattice::Point> OutlineLattice::midway_points(int step) const {
    std::vector<Point> midway = points(step);
    std::erase_if(midway, [step](Point p) { return p.column % (2 * step) == 0 && p.row % (2 * step) == 0; });
    return midway;
}

std::vector<OutlineLattice::Point> OutlineLattice::found_points() const {
    std::vector<Point> found = points();
    std::erase_if(found, [this](Point point) { return !has(point); });
    return found;
}

std::vector<PupilOutline> OutlineLattice::outlines(const std::vector<Point>& points) const {
    std::vector<PupilOutline> outlines;
    for (const Point point : points)
        for (int half = 0; half < halves_; ++half) outlines.push_back(outline(point, half));
    return outlines;
}

std::vector<PupilOutline> OutlineLattice::expected(const std::vector<Point>& midway, int step) const {
    std::vector<PupilOutline> expected;
    for (const auto [column, row] : midway) {
        const int dx = column % (2 * step), dy = row % (2 * step);
        for (int half = 0; half < halves_; ++half) {
            std::vector<const PupilOutline*> around;
            for (int y = row - dy; y <= row + dy; y += 2 * step)
                for (int x = column - dx; x <= column + dx; x += 2 * step) around.push_back(&outline({x, y}, half));
            expected.push_back(mean_outline(around));
        }
    }
    return expected;
}

std::vector<PupilOutline> OutlineLattice::outlines_of_cell(int column, int row, int half) const {
    const int per_cell = static_cast<int>(1 / spacing_);
    std::vector<PupilOutline> outlines;
    for (int y = per_cell * row; y <= std::min(per_cell * (row + 1), rows_ - 1); ++y)
        for (int x = per_cell * column; x <= std::min(per_cell * (column + 1), columns_ - 1); ++x)
            if (has({x, y})) outlines.push_back(outline({x, y}, half));
    return outlines;
}

void OutlineLattice::store(const std::vector<Point>& points, const std::vector<PupilOutline>& found) {
    int next = static_cast<int>(outlines_.size());
    for (const Point point : points) {
        slot(point) = next;
        next += halves_;
    }
    outlines_.insert(outlines_.end(), found.begin(), found.end());
}

}  // namespace realcam
