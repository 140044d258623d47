#include "pupil_grid.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "../../math/random.hpp"

namespace realcam {

namespace {

template <class T>
std::vector<T> at(const std::vector<std::size_t>& indices, const std::vector<T>& all) {
    std::vector<T> some;
    for (const std::size_t index : indices) some.push_back(all[index]);
    return some;
}

template <class T>
void assign_at(const std::vector<std::size_t>& indices, const std::vector<T>& some, std::vector<T>& all) {
    for (std::size_t i = 0; i < indices.size(); ++i) all[indices[i]] = some[i];
}

}  // namespace

bool has_radial_pupil(const LensSystem& lens) {
    return lens.is_rotational() && std::isinf(lens.film_radius_of_curvature);
}

void require_radial_pupil(const LensSystem& lens, const std::string& what) {
    if (!has_radial_pupil(lens))
        throw InputError(what + " needs a centred lens of revolution before a flat film; " +
                         (lens.is_rotational() ? "its film is curved" : lens.asymmetry()));
}

MirrorPlanes mirror_planes(const LensSystem& lens) {
    MirrorPlanes planes{true, true};
    const auto heed = [&](const SurfacePlacement& placement) {
        const auto& [decentre, tilt, returns] = placement;
        planes.x &= decentre.x == 0 && tilt.y == 0 && tilt.z == 0;
        planes.y &= decentre.y == 0 && tilt.x == 0 && tilt.z == 0;
    };
    for (const Surface& surface : lens.surfaces) {
        heed(surface.placement);
        for (const XyTerm& term : surface.form.xy) {
            planes.x &= term.x % 2 == 0;
            planes.y &= term.y % 2 == 0;
        }
        const ApertureShape& aperture = surface.aperture_shape;
        planes.x &= aperture.offset.x == 0;
        planes.y &= aperture.offset.y == 0;
        // These may be symmetric, too, but rarely are.
        bool is_asymmetric = false;
        over_terms(surface.form, [&](const auto& terms) { is_asymmetric |= *terms.words.asymmetry != 0; });
        if (is_asymmetric || aperture.kind == ApertureOutline::polygon || !aperture.obscurations.empty()) return {};
    }
    heed(lens.film_placement);
    return planes;
}

PupilGrid::PupilGrid(const LensSystem& lens, const FilmArea& film, MirrorPlanes planes, PupilTracer tracer,
                     const std::vector<double>& wavelengths_nm)
    : search_(lens, FilmMap::planar, std::move(tracer), wavelengths_nm), film_(film), planes_(planes) {
    const auto fold = [](double& least, double& most, int& cells) {
        most = std::max(std::fabs(least), std::fabs(most));
        least = 0;
        cells /= 2;
    };
    if (planes.x) fold(film_.least.x, film_.most.x, columns_);
    if (planes.y) fold(film_.least.y, film_.most.y, rows_);
    find_nodes();
    cells_.resize(static_cast<std::size_t>(columns_ * rows_));
    sectors_.resize(cells_.size() * 2 * PupilGridView::kSectors);
    if (!is_lit_) return;
    find_cells(sharpen_nodes());
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
    // Starts at the film's centre, which is lit, if anything is, in all but unusual cameras.
    int first_column = planes_.x ? 0 : columns / 2, first_row = planes_.y ? 0 : rows / 2;
    std::optional<DirectionBox> first = search_.look(node_point(first_column, first_row), {});
    for (int row = 0; row < rows && !first; ++row)
        for (int column = 0; column < columns && !first; ++column) {
            first = search_.look(node_point(column, row), {});
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
            boxes[static_cast<std::size_t>(i)] = look(column, row, found, first_column, first_row);
        });
        for (std::size_t i = 0; i < positions.size(); ++i)
            found[node_index(positions[i].first, positions[i].second)] = boxes[i];
    }
    // From the first node outwards, so that every inner neighbour has its box.
    for (int ring = 0; ring <= std::max(columns, rows); ++ring)
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column) {
                if (distance(column, row) != ring) continue;
                PupilGridNode& node = nodes_[node_index(column, row)];
                const std::optional<DirectionBox>& box = found[node_index(column, row)];
                const auto inwards = [](int at, int start) { return at - (at > start) + (at < start); };
                node = box ? node_of(*box) : nodes_[node_index(inwards(column, first_column), inwards(row, first_row))];
            }
}

std::optional<DirectionBox> PupilGrid::look(int column, int row, const std::vector<std::optional<DirectionBox>>& found,
                                            int from_column, int from_row) const {
    const int dx = (column < from_column) - (column > from_column), dy = (row < from_row) - (row > from_row);
    std::optional<DirectionBox> expected = found[node_index(column + dx, row + dy)];
    const int before_column = column + 2 * dx, before_row = row + 2 * dy;
    const bool has_before = std::max(std::abs(column - from_column), std::abs(row - from_row)) >= 2 &&
                            before_column >= 0 && before_column < node_columns() && before_row >= 0 &&
                            before_row < node_rows();
    if (expected && has_before)
        if (const auto& before = found[node_index(before_column, before_row)])
            expected = expected->joined_with(expected->moved_on_from(*before, 1));
    return search_.look(node_point(column, row), expected);
}

std::vector<PupilOutline> PupilGrid::sharpen_nodes() {
    const Lattice lattice{node_columns(), node_rows()};
    std::vector<OutlineLook> looks;
    for (int row = 0; row < lattice.rows; ++row)
        for (int column = 0; column < lattice.columns; ++column)
            add_looks(kCellsPerPupilNode * column, kCellsPerPupilNode * row, looks);
    std::vector<PupilOutline> outlines(looks.size());
    const std::vector<std::size_t> coarse = lattice.even_looks();
    assign_at(coarse, OutlineSearch::find(search_.lens(), at(coarse, looks)), outlines);
    // The box found by a grid of rays is off by up to two of the grid's cells.
    look_between(lattice, looks, 0.12, outlines);
    for (std::size_t node = 0; node < nodes_.size(); ++node) {
        DirectionBox box = DirectionBox::none();
        for (const std::size_t half : {2 * node, 2 * node + 1})
            for (int a = 0; a <= PupilOutline::kAzimuths; ++a) {
                const double reach = outlines[half].outer[a];
                if (reach > 0) box = box.with(looks[half].direction(a, reach));
            }
        if (!(box.l_max > box.l_min && box.m_max > box.m_min)) continue;
        nodes_[node] = node_of(box);
        const OutlineLook& upper = looks[2 * node];
        const auto before = DirectionBox::around(upper.centre, upper.half_width, upper.half_height);
        const OutlineHalves halves = moved_outline({outlines[2 * node], outlines[2 * node + 1]}, before, box);
        std::copy(halves.begin(), halves.end(), outlines.begin() + static_cast<std::ptrdiff_t>(2 * node));
    }
    return outlines;
}

void PupilGrid::add_looks(double column, double row, std::vector<OutlineLook>& looks) const {
    const PupilGridNode box = box_at(column, row);
    for (const int sign : {1, -1})
        looks.push_back({film_point(column, row),
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

std::vector<PupilOutline> PupilGrid::outlines(const std::vector<PupilOutline>& of_nodes) const {
    const Lattice lattice{columns_ + 1, rows_ + 1};
    std::vector<OutlineLook> looks;
    for (int row = 0; row <= rows_; ++row)
        for (int column = 0; column <= columns_; ++column) add_looks(column, row, looks);
    std::vector<PupilOutline> found(looks.size());
    const std::vector<std::size_t> at_nodes = lattice.even_looks();
    assign_at(at_nodes, OutlineSearch::find_near(search_.lens(), at(at_nodes, looks), of_nodes, OutlineSearch::kChange),
              found);
    look_between(lattice, looks, OutlineSearch::kChange, found);
    return found;
}

void PupilGrid::look_between(Lattice lattice, const std::vector<OutlineLook>& looks, double tolerance,
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
                        around.push_back(&outlines[lattice.look(x, y) + half]);
                indices.push_back(lattice.look(column, row) + half);
                expected.push_back(between(around));
            }
        }
    assign_at(indices, OutlineSearch::find_near(search_.lens(), at(indices, looks), expected, tolerance), outlines);
}

void PupilGrid::find_cells(const std::vector<PupilOutline>& of_nodes) {
    const std::vector<PupilOutline> all = outlines(of_nodes);
    search_.lens().for_each(columns_ * rows_, [&](int cell) { set_cell(cell % columns_, cell / columns_, all); });
}

void PupilGrid::set_cell(int column, int row, const std::vector<PupilOutline>& outlines) {
    std::vector<PupilOutline> seen[2];
    bool is_partly_dark = false;
    for (int y = row; y <= row + 1; ++y)
        for (int x = column; x <= column + 1; ++x) {
            bool is_dark = true;
            for (int half = 0; half < 2; ++half) {
                const auto at = static_cast<std::size_t>(2 * (y * (columns_ + 1) + x) + half);
                seen[half].push_back(outlines[at]);
                is_dark &= std::none_of(std::begin(outlines[at].outer), std::end(outlines[at].outer),
                                        [](double reach) { return reach > 0; });
            }
            is_partly_dark |= is_dark;
        }
    const bool changes = is_partly_dark || std::max(largest_spread(seen[0]), largest_spread(seen[1])) > 0.2;
    const double reach = changes ? 1.5 : 1.2;
    PupilHalves halves;
    for (const std::vector<PupilOutline>& half : seen)
        halves.emplace_back(is_partly_dark ? box_outline() : holding_all(half));
    const auto start = [&](int, std::uint32_t stream, const StraySearch::Places& positions, PupilRays& rays) {
        set_rays(column, row, stream, positions, rays);
    };
    const StraySearch search{128, static_cast<std::uint32_t>(row * columns_ + column), 1, reach, changes ? 6 : 2};
    const StraySearch::Traced traced = search.widen(search_.lens(), start, halves);
    PupilGridCell& cell = cells_[static_cast<std::size_t>(row * columns_ + column)];
    PupilSector* const sectors = sectors_.data() + (&cell - cells_.data()) * 2 * PupilGridView::kSectors;
    double areas[2] = {0, 0};
    for (int half = 0; half < 2; ++half) {
        std::copy(halves[half].sectors().begin(), halves[half].sectors().end(),
                  sectors + half * PupilGridView::kSectors);
        areas[half] = halves[half].area();
    }
    // At least 1%: rounding may still select a half without light.
    const double share = std::clamp(areas[0] / (areas[0] + areas[1]), 0.01, 0.99);
    cell.upper_share = static_cast<float>(share);
    if (traced.around_passed + traced.beside_passed == 0) return;  // a dark cell's weights stay 0
    cell.upper_weight = static_cast<float>(0.5 * PupilGridView::kSectors / share);
    cell.lower_weight = static_cast<float>(0.5 * PupilGridView::kSectors / (1 - share));
}

void PupilGrid::set_rays(int column, int row, std::uint32_t stream, const StraySearch::Places& positions,
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
