#include "pupil_grid.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace realcam {

PupilGrid::PupilGrid(const LensSystem& lens, const FilmArea& film, MirrorPlanes planes, PupilTracer tracer,
                     const std::vector<double>& wavelengths_nm)
    : PupilTable({lens, FilmMap::planar, std::move(tracer), wavelengths_nm}, {film, planes}) {
    find_nodes();
    halves_.resize(static_cast<std::size_t>(points_.columns * points_.rows));
    sectors_.resize(halves_.size() * Map::kHalves * kPupilSectors);
    if (!is_lit_) return;
    add_cells(find_outlines(refine_nodes()));
}

void PupilGrid::find_nodes() {
    const int columns = node_columns(), rows = node_rows();
    std::vector<std::optional<DirectionBox>> found(static_cast<std::size_t>(columns * rows));
    // The search starts at the film's centre, which light reaches in all but unusual cameras.
    int first_column = points_.planes.x ? 0 : columns / 2, first_row = points_.planes.y ? 0 : rows / 2;
    std::optional<DirectionBox> first = search_.find(node_point(first_column, first_row), {});
    for (int row = 0; row < rows && !first; ++row)
        for (int column = 0; column < columns && !first; ++column) {
            first = search_.find(node_point(column, row), {});
            if (first) first_column = column, first_row = row;
        }
    nodes_.assign(found.size(), Node{});
    if (!first) return;
    is_lit_ = true;
    const auto inward = [](int i, int start) { return (i < start) - (i > start); };
    for (int ring = 0; ring <= std::max(columns, rows); ++ring) {
        std::vector<std::pair<int, int>> positions;
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column)
                if (std::max(std::abs(column - first_column), std::abs(row - first_row)) == ring)
                    positions.emplace_back(column, row);
        std::vector<std::optional<DirectionBox>> boxes(positions.size(), first);
        const auto find = [&](int i) {
            const auto [column, row] = positions[static_cast<std::size_t>(i)];
            boxes[static_cast<std::size_t>(i)] =
                find_node(column, row, inward(column, first_column), inward(row, first_row), ring, found);
        };
        if (ring > 0) search_.lens().for_each(static_cast<int>(positions.size()), find);
        for (std::size_t i = 0; i < positions.size(); ++i) {
            const auto [column, row] = positions[i];
            const std::size_t node = node_index(column, row),
                              inner = node_index(column + inward(column, first_column), row + inward(row, first_row));
            found[node] = boxes[i];
            nodes_[node] = boxes[i] ? node_of(*boxes[i]) : nodes_[inner];
        }
    }
}

std::optional<DirectionBox> PupilGrid::find_node(int column, int row, int dx, int dy, int ring,
                                                 const std::vector<std::optional<DirectionBox>>& found) const {
    std::optional<DirectionBox> expected = found[node_index(column + dx, row + dy)];
    const int before_column = column + 2 * dx, before_row = row + 2 * dy;
    const bool has_before = ring >= 2 && before_column >= 0 && before_column < node_columns() && before_row >= 0 &&
                            before_row < node_rows();
    if (expected && has_before)
        if (const auto& before = found[node_index(before_column, before_row)])
            expected = expected->expected_after(*before, 1);
    return search_.find(node_point(column, row), expected);
}

std::vector<PupilOutline> PupilGrid::refine_nodes() {
    OutlineLattice lattice(node_columns(), node_rows(), Map::kHalves, Map::kCellsPerNode);
    find_every(2, lattice);
    constexpr double kBoxError = 0.12;  // of a box found by a grid of rays: up to two of the grid's cells
    find_midway(lattice.midway_points(1), 1, kBoxError, lattice);
    const std::vector<OutlineRequest> requests = requests_at(lattice, lattice.points());
    std::vector<PupilOutline> outlines = lattice.outlines(lattice.points());
    for (std::size_t node = 0; node < nodes_.size(); ++node) {
        DirectionBox box = DirectionBox::empty();
        for (const std::size_t half : {2 * node, 2 * node + 1})
            for (int a = 0; a <= PupilOutline::kAzimuths; ++a) {
                const double radius = outlines[half].outer[a];
                if (radius > 0) box = box.extended_to(requests[half].direction(a, radius));
            }
        if (!(box.l_max > box.l_min && box.m_max > box.m_min)) continue;
        nodes_[node] = node_of(box);
        const OutlineRequest& upper = requests[2 * node];
        const auto before = DirectionBox::around(upper.centre, upper.half_width, upper.half_height);
        const OutlineHalves halves = moved_outline({outlines[2 * node], outlines[2 * node + 1]}, before, box);
        std::copy(halves.begin(), halves.end(), outlines.begin() + static_cast<std::ptrdiff_t>(2 * node));
    }
    return outlines;
}

OutlineLattice PupilGrid::find_outlines(const std::vector<PupilOutline>& node_outlines) const {
    constexpr double kTolerance = OutlineSearch::kNeighbourTolerance;
    OutlineLattice outlines(points_.columns + 1, points_.rows + 1, Map::kHalves, 1);
    const LatticePoints at_nodes = outlines.points(Map::kCellsPerNode);
    outlines.store(at_nodes, find_near(outlines, at_nodes, node_outlines, kTolerance));
    find_midway(outlines.midway_points(1), 1, kTolerance, outlines);
    return outlines;
}

void PupilGrid::add_cells(const OutlineLattice& outlines) {
    search_.lens().for_each(points_.columns * points_.rows,
                            [&](int cell) { add_cell(cell % points_.columns, cell / points_.columns, outlines); });
}

void PupilGrid::add_cell(int column, int row, const OutlineLattice& outlines) {
    const std::vector<PupilOutline> outlines_of_half[2] = {outlines.outlines_of_cell(column, row, 0),
                                                           outlines.outlines_of_cell(column, row, 1)};
    const auto is_dark = [](const PupilOutline& outline) {
        return std::none_of(std::begin(outline.outer), std::end(outline.outer), [](double r) { return r > 0; });
    };
    bool is_partly_dark = false;
    for (std::size_t corner = 0; corner < outlines_of_half[0].size(); ++corner)
        is_partly_dark |= is_dark(outlines_of_half[0][corner]) && is_dark(outlines_of_half[1][corner]);
    // Surroundings are larger, and rounds more, for cells over which the outline changes much.
    constexpr double kMaxRadiusRange = 0.2;
    const bool changes = is_partly_dark || std::max(largest_radius_range(outlines_of_half[0]),
                                                    largest_radius_range(outlines_of_half[1])) > kMaxRadiusRange;
    PupilHalves halves;
    for (const std::vector<PupilOutline>& half : outlines_of_half)
        halves.emplace_back(is_partly_dark ? box_outline() : enclosing_outline(half));
    const StraySearch::Traced traced =
        extend_to_strays(column, row, changes ? StrayExtent{1.5, 6} : StrayExtent{1.2, 2}, halves);
    store(column, row, halves);
    // The fraction is at least 1%, because rounding may select a half without light nevertheless.
    const double upper_area = halves[0].area(),
                 upper_fraction = std::clamp(upper_area / (upper_area + halves[1].area()), 0.01, 0.99);
    PupilHalfSampling& sampling = halves_[static_cast<std::size_t>(cell_index(column, row))];
    sampling.upper_probability = static_cast<float>(upper_fraction);
    if (traced.passed_all_over + traced.passed_beside == 0) return;  // the weights of a dark cell stay 0
    sampling.upper_weight = static_cast<float>(0.5 * kPupilSectors / upper_fraction);
    sampling.lower_weight = static_cast<float>(0.5 * kPupilSectors / (1 - upper_fraction));
}

}  // namespace realcam
