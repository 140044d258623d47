#include "pupil_grid.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "../../math/random.hpp"

namespace realcam {

namespace {

/// Returns the elements of a list at these indices.
template <class T>
std::vector<T> elements_at(const std::vector<std::size_t>& indices, const std::vector<T>& list) {
    std::vector<T> elements;
    for (const std::size_t index : indices) elements.push_back(list[index]);
    return elements;
}

/// Assigns elements to a list at these indices.
template <class T>
void assign_at(const std::vector<std::size_t>& indices, const std::vector<T>& elements, std::vector<T>& list) {
    for (std::size_t i = 0; i < indices.size(); ++i) list[indices[i]] = elements[i];
}

}  // namespace

bool has_radial_pupil(const LensSystem& lens) {
    return lens.is_rotational() && std::isinf(lens.film_radius_of_curvature);
}

void require_radial_pupil(const LensSystem& lens, const std::string& what) {
    if (!has_radial_pupil(lens))
        throw InputError(what + " needs a rotationally symmetric lens with a flat film; " +
                         (lens.is_rotational() ? "its film is curved" : lens.asymmetry()));
}

MirrorPlanes mirror_planes(const LensSystem& lens) {
    MirrorPlanes planes{true, true};
    const auto clear_broken_symmetries = [&](const SurfacePlacement& placement) {
        const auto& [decentre, tilt, returns] = placement;
        planes.x &= decentre.x == 0 && tilt.y == 0 && tilt.z == 0;
        planes.y &= decentre.y == 0 && tilt.x == 0 && tilt.z == 0;
    };
    for (const Surface& surface : lens.surfaces) {
        clear_broken_symmetries(surface.placement);
        for (const XyTerm& term : surface.form.xy) {
            planes.x &= term.x % 2 == 0;
            planes.y &= term.y % 2 == 0;
        }
        const ApertureShape& aperture = surface.aperture_shape;
        planes.x &= aperture.offset.x == 0;
        planes.y &= aperture.offset.y == 0;
        // Shapes of these kinds can be symmetric, but rarely are.
        bool is_asymmetric = false;
        for_each_present_terms(surface.form, [&](const auto& terms) { is_asymmetric |= *terms.words.asymmetry != 0; });
        if (is_asymmetric || aperture.kind == ApertureOutline::polygon || !aperture.obscurations.empty()) return {};
    }
    clear_broken_symmetries(lens.film_placement);
    return planes;
}

PupilGrid::PupilGrid(const LensSystem& lens, const FilmArea& film, MirrorPlanes planes, PupilTracer tracer,
                     const std::vector<double>& wavelengths_nm)
    : search_(lens, FilmMap::planar, std::move(tracer), wavelengths_nm), film_(film), planes_(planes) {
    const auto restrict_to_half = [](double& low, double& high, int& cells) {
        high = std::max(std::fabs(low), std::fabs(high));
        low = 0;
        cells /= 2;
    };
    if (planes.x) restrict_to_half(film_.least.x, film_.most.x, columns_);
    if (planes.y) restrict_to_half(film_.least.y, film_.most.y, rows_);
    find_nodes();
    cells_.resize(static_cast<std::size_t>(columns_ * rows_));
    sectors_.resize(cells_.size() * 2 * PupilGridView::kSectors);
    if (!is_lit_) return;
    find_cells(refine_nodes());
}

PupilGridView PupilGrid::view() const {
    return {nodes_.data(),
            cells_.data(),
            sectors_.data(),
            columns_,
            rows_,
            {static_cast<float>(film_.least.x), static_cast<float>(film_.least.y)},
            {static_cast<float>(columns_ / (film_.most.x - film_.least.x)),
             static_cast<float>(rows_ / (film_.most.y - film_.least.y))},
            planes_.x,
            planes_.y,
            static_cast<float>(search_.lens().index_squared())};
}

Vec2<double> PupilGrid::film_point(double column, double row) const {
    return {film_.least.x + column / columns_ * (film_.most.x - film_.least.x),
            film_.least.y + row / rows_ * (film_.most.y - film_.least.y)};
}

void PupilGrid::find_nodes() {
    const int columns = node_columns(), rows = node_rows();
    std::vector<std::optional<DirectionBox>> found(static_cast<std::size_t>(columns * rows));
    // The search starts at the film's centre, which light reaches in all but unusual cameras.
    int first_column = planes_.x ? 0 : columns / 2, first_row = planes_.y ? 0 : rows / 2;
    std::optional<DirectionBox> first = search_.find(node_point(first_column, first_row), {});
    for (int row = 0; row < rows && !first; ++row)
        for (int column = 0; column < columns && !first; ++column) {
            first = search_.find(node_point(column, row), {});
            if (first) first_column = column, first_row = row;
        }
    nodes_.assign(found.size(), PupilGridNode{});
    if (!first) return;
    is_lit_ = true;
    found[node_index(first_column, first_row)] = first;
    const auto distance = [&](int column, int row) {
        return std::max(std::abs(column - first_column), std::abs(row - first_row));
    };
    for (int ring = 1; ring <= std::max(columns, rows); ++ring) {
        std::vector<std::pair<int, int>> positions;
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column)
                if (distance(column, row) == ring) positions.emplace_back(column, row);
        std::vector<std::optional<DirectionBox>> boxes(positions.size());
        search_.lens().for_each(static_cast<int>(positions.size()), [&](int i) {
            const auto [column, row] = positions[static_cast<std::size_t>(i)];
            boxes[static_cast<std::size_t>(i)] = find_node(column, row, found, first_column, first_row);
        });
        for (std::size_t i = 0; i < positions.size(); ++i)
            found[node_index(positions[i].first, positions[i].second)] = boxes[i];
    }
    // The order is from the first node outwards, so that the inner neighbours of each node have their boxes.
    for (int ring = 0; ring <= std::max(columns, rows); ++ring)
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column) {
                if (distance(column, row) != ring) continue;
                PupilGridNode& node = nodes_[node_index(column, row)];
                const std::optional<DirectionBox>& box = found[node_index(column, row)];
                const auto towards = [](int i, int start) { return i - (i > start) + (i < start); };
                node = box ? node_of(*box) : nodes_[node_index(towards(column, first_column), towards(row, first_row))];
            }
}

std::optional<DirectionBox> PupilGrid::find_node(int column, int row,
                                                 const std::vector<std::optional<DirectionBox>>& found, int from_column,
                                                 int from_row) const {
    const int dx = (column < from_column) - (column > from_column), dy = (row < from_row) - (row > from_row);
    std::optional<DirectionBox> expected = found[node_index(column + dx, row + dy)];
    const int before_column = column + 2 * dx, before_row = row + 2 * dy;
    const bool has_before = std::max(std::abs(column - from_column), std::abs(row - from_row)) >= 2 &&
                            before_column >= 0 && before_column < node_columns() && before_row >= 0 &&
                            before_row < node_rows();
    if (expected && has_before)
        if (const auto& before = found[node_index(before_column, before_row)])
            expected = expected->joined_with(expected->extrapolated_from(*before, 1));
    return search_.find(node_point(column, row), expected);
}

std::vector<PupilOutline> PupilGrid::refine_nodes() {
    const Lattice lattice{node_columns(), node_rows()};
    std::vector<OutlineRequest> requests;
    for (int row = 0; row < lattice.rows; ++row)
        for (int column = 0; column < lattice.columns; ++column)
            add_requests(kCellsPerPupilNode * column, kCellsPerPupilNode * row, requests);
    std::vector<PupilOutline> outlines(requests.size());
    const std::vector<std::size_t> coarse = lattice.even_requests();
    assign_at(coarse, OutlineSearch::find(search_.lens(), elements_at(coarse, requests)), outlines);
    constexpr double kBoxError = 0.12;  // of a box found by a grid of rays: up to two of the grid's cells
    find_midway(lattice, requests, kBoxError, outlines);
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

void PupilGrid::add_requests(double column, double row, std::vector<OutlineRequest>& requests) const {
    const PupilGridNode box = box_at(column, row);
    for (const int sign : {1, -1})
        requests.push_back({film_point(column, row),
                            {static_cast<double>(box.centre_l), static_cast<double>(box.centre_m)},
                            static_cast<double>(box.half_width),
                            sign * static_cast<double>(box.half_height)});
}

PupilGridNode PupilGrid::node_of(const DirectionBox& box) {
    return {static_cast<float>(box.centre().l), static_cast<float>(box.centre().m),
            static_cast<float>(box.half_width()), static_cast<float>(box.half_height())};
}

PupilGridNode PupilGrid::box_at(double column, double row) const {
    const PupilGridView grid = view();
    const Vec2<double> film = film_point(column, row);
    return pupil_lookup(grid, static_cast<float>(film.x), static_cast<float>(film.y)).box;
}

std::vector<PupilOutline> PupilGrid::outlines(const std::vector<PupilOutline>& node_outlines) const {
    const Lattice lattice{columns_ + 1, rows_ + 1};
    std::vector<OutlineRequest> requests;
    for (int row = 0; row <= rows_; ++row)
        for (int column = 0; column <= columns_; ++column) add_requests(column, row, requests);
    std::vector<PupilOutline> found(requests.size());
    const std::vector<std::size_t> at_nodes = lattice.even_requests();
    assign_at(at_nodes,
              OutlineSearch::find_near(search_.lens(), elements_at(at_nodes, requests), node_outlines,
                                       OutlineSearch::kNeighbourTolerance),
              found);
    find_midway(lattice, requests, OutlineSearch::kNeighbourTolerance, found);
    return found;
}

void PupilGrid::find_midway(Lattice lattice, const std::vector<OutlineRequest>& requests, double tolerance,
                            std::vector<PupilOutline>& outlines) const {
    std::vector<std::size_t> indices;
    std::vector<PupilOutline> expected;
    for (int row = 0; row < lattice.rows; ++row)
        for (int column = 0; column < lattice.columns; ++column) {
            const int dx = column % 2, dy = row % 2;
            if (dx == 0 && dy == 0) continue;
            for (std::size_t half = 0; half < 2; ++half) {
                std::vector<const PupilOutline*> around;
                for (int y = row - dy; y <= row + dy; y += 2)
                    for (int x = column - dx; x <= column + dx; x += 2)
                        around.push_back(&outlines[lattice.request(x, y) + half]);
                indices.push_back(lattice.request(column, row) + half);
                expected.push_back(mean_outline(around));
            }
        }
    assign_at(indices, OutlineSearch::find_near(search_.lens(), elements_at(indices, requests), expected, tolerance),
              outlines);
}

void PupilGrid::find_cells(const std::vector<PupilOutline>& node_outlines) {
    const std::vector<PupilOutline> all = outlines(node_outlines);
    search_.lens().for_each(columns_ * rows_, [&](int cell) { set_cell(cell % columns_, cell / columns_, all); });
}

void PupilGrid::set_cell(int column, int row, const std::vector<PupilOutline>& outlines) {
    std::vector<PupilOutline> outlines_of_half[2];
    bool is_partly_dark = false;
    for (int y = row; y <= row + 1; ++y)
        for (int x = column; x <= column + 1; ++x) {
            bool is_dark = true;
            for (int half = 0; half < 2; ++half) {
                const auto index = static_cast<std::size_t>(2 * (y * (columns_ + 1) + x) + half);
                outlines_of_half[half].push_back(outlines[index]);
                is_dark &= std::none_of(std::begin(outlines[index].outer), std::end(outlines[index].outer),
                                        [](double radius) { return radius > 0; });
            }
            is_partly_dark |= is_dark;
        }
    // Surroundings are larger, and rounds more, for cells over which the outline changes much.
    constexpr double kMaxRadiusRange = 0.2;
    const bool changes = is_partly_dark || std::max(largest_radius_range(outlines_of_half[0]),
                                                    largest_radius_range(outlines_of_half[1])) > kMaxRadiusRange;
    const double half_size = changes ? 1.5 : 1.2;
    PupilHalves halves;
    for (const std::vector<PupilOutline>& half : outlines_of_half)
        halves.emplace_back(is_partly_dark ? box_outline() : enclosing_outline(half));
    const auto set_cell_rays = [&](int, std::uint32_t stream, const StraySearch::Points& positions, PupilRays& rays) {
        set_rays(column, row, stream, positions, rays);
    };
    constexpr int kMaxRounds = 128, kPointDimension = 1;  // set_rays uses dimension 0
    const StraySearch search{kMaxRounds, static_cast<std::uint32_t>(row * columns_ + column), kPointDimension,
                             half_size, changes ? 6 : 2};
    const StraySearch::Traced traced = search.widen(search_.lens(), set_cell_rays, halves);
    PupilGridCell& cell = cells_[static_cast<std::size_t>(row * columns_ + column)];
    PupilSector* const sectors = sectors_.data() + (&cell - cells_.data()) * 2 * PupilGridView::kSectors;
    double areas[2] = {0, 0};
    for (int half = 0; half < 2; ++half) {
        std::copy(halves[half].sectors().begin(), halves[half].sectors().end(),
                  sectors + half * PupilGridView::kSectors);
        areas[half] = halves[half].area();
    }
    // The fraction is at least 1%, because rounding may select a half without light nevertheless.
    const double upper_fraction = std::clamp(areas[0] / (areas[0] + areas[1]), 0.01, 0.99);
    cell.upper_probability = static_cast<float>(upper_fraction);
    if (traced.passed_all_over + traced.passed_beside == 0) return;  // the weights of a dark cell stay 0
    cell.upper_weight = static_cast<float>(0.5 * PupilGridView::kSectors / upper_fraction);
    cell.lower_weight = static_cast<float>(0.5 * PupilGridView::kSectors / (1 - upper_fraction));
}

void PupilGrid::set_rays(int column, int row, std::uint32_t stream, const StraySearch::Points& positions,
                         PupilRays& rays) const {
    Vec2Lanes<float, kBlock> in_cell;
    for (int i = 0; i < kBlock; ++i) in_cell.set(i, sample_2d(stream, static_cast<std::uint32_t>(i), 0));
    const int node_column = column / kCellsPerPupilNode, node_row = row / kCellsPerPupilNode;
    const PupilGridNode* const near = nodes_.data() + node_index(node_column, node_row);
    const PupilGridNode* const far = near + node_columns();
    const Vec2<double> corner = film_point(column, row), opposite = film_point(column + 1, row + 1);
    const float left = static_cast<float>(column % kCellsPerPupilNode),
                low = static_cast<float>(row % kCellsPerPupilNode);
    const PupilGridNode a = near[0], b = near[1], c = far[0], d = far[1];
    REALCAM_LANES
    for (int i = 0; i < kBlock; ++i) {
        const float fx = (left + in_cell.x[i]) / kCellsPerPupilNode, fy = (low + in_cell.y[i]) / kCellsPerPupilNode;
        const auto between = [fx, fy](float at_a, float at_b, float at_c, float at_d) {
            const float first = at_a + fx * (at_b - at_a), second = at_c + fx * (at_d - at_c);
            return first + fy * (second - first);
        };
        rays.x[i] = corner.x + static_cast<double>(in_cell.x[i]) * (opposite.x - corner.x);
        rays.y[i] = corner.y + static_cast<double>(in_cell.y[i]) * (opposite.y - corner.y);
        rays.l[i] =
            static_cast<double>(between(a.centre_l, b.centre_l, c.centre_l, d.centre_l) +
                                positions.x[i] * between(a.half_width, b.half_width, c.half_width, d.half_width));
        rays.m[i] =
            static_cast<double>(between(a.centre_m, b.centre_m, c.centre_m, d.centre_m) +
                                positions.y[i] * between(a.half_height, b.half_height, c.half_height, d.half_height));
    }
}

}  // namespace realcam
