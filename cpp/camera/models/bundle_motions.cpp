#include "bundle_motions.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>

#include "../../math/matrix2.hpp"
#include "chief_rays.hpp"
#include "pinhole_camera.hpp"

namespace realcam {
namespace {

/// A node's chief ray in front of the lens and its calibrated direction.
struct Node {
    RayLine lens;
    Vec3d direction;
};

/// Matrix that takes a small displacement on the film, behind the lens whose bundle moves as that of node `at`, to the
/// displacement in the calibrated picture that sees the same change of direction. `along_x`, `along_y`: nodes on both
/// sides of it.
Matrix2 landing_matrix(const Node& at, const Node (&along_x)[2], const Node (&along_y)[2]) {
    const Vec3d d = at.direction, axis = std::fabs(d.x) < 0.9 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
    const Vec3d s = normalized(cross(axis, d)), t = cross(d, s);
    const auto differences = [&](auto&& direction_of) {
        const Vec3d x = direction_of(along_x[1]) - direction_of(along_x[0]),
                    y = direction_of(along_y[1]) - direction_of(along_y[0]);
        return Matrix2{{dot(x, s), dot(y, s)}, {dot(x, t), dot(y, t)}};
    };
    const Matrix2 calibrated = differences([](const Node& node) { return node.direction; });
    const Matrix2 behind_lens =
        differences([&](const Node& node) { return rotated(cross(at.lens.direction, d), node.lens.direction); });
    const Matrix2 identity = {{1, 0}, {0, 1}};
    // At a fold, where the calibration is extrapolated, there is no inverse.
    if (!(calibrated.determinant() * behind_lens.determinant() > 0)) return identity;
    const Matrix2 matrix = calibrated.inverse() * behind_lens;
    constexpr double kMaxElement = 4;
    for (const Vec2<double> row : {matrix.first, matrix.second})
        if (!(std::max(std::fabs(row.x), std::fabs(row.y)) <= kMaxElement)) return identity;
    return matrix;
}

}  // namespace

BundleMotions::BundleMotions(const Camera& camera, const CameraView& view, const PupilTracer& tracer)
    : geometry_(camera.geometry) {
    const CalibratedGeometry& geometry = *geometry_;
    const Film& film = camera.film;
    const int columns = geometry.columns, rows = geometry.rows;
    // Film point of picture coordinates. The lens inverts the picture, and film y points up while rows go down.
    const auto film_of = [&](double x, double y) {
        const Vec2<double> point = film.point_of({x * film.width, y * film.height});
        return Vec2<double>{-point.x, -point.y};
    };
    const auto coordinate = [&](int index, int cells) {
        return (1 + 2 * geometry.margin) * index / cells - geometry.margin;
    };
    const ChiefRays chief_rays(camera, view, geometry.margin);
    std::vector<Node> all(geometry.directions.size());
    const double least_cosine = std::cos(kMaxAngle * std::numbers::pi / 180);
    const auto node_at = [&](int column, int row) -> Node& {
        return all[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns + 1) +
                   static_cast<std::size_t>(column)];
    };
    tracer.for_each(rows + 1, [&](int row) {
        for (int column = 0; column <= columns; ++column) {
            Node& node = node_at(column, row);
            const double x = coordinate(column, columns), y = coordinate(row, rows);
            node.lens = chief_rays.at(film_of(x, y));
            node.direction = geometry.directions[static_cast<std::size_t>(&node - all.data())];
            const bool is_in_picture = x >= 0 && x <= 1 && y >= 0 && y <= 1;
            if (dot(node.lens.direction, node.direction) >= least_cosine) continue;
            const auto cell = [](double u, int cells) { return std::min(static_cast<int>(u * cells), cells - 1); };
            const bool is_seen =
                is_in_picture &&
                (geometry.mask.cells.empty() ||
                 geometry.mask.cells[static_cast<std::size_t>(cell(y, geometry.mask.rows) * geometry.mask.columns +
                                                              cell(x, geometry.mask.columns))]);
            if (is_seen)
                throw InputError("the calibration's direction at pixel (" +
                                 std::to_string(static_cast<int>(x * film.width)) + ", " +
                                 std::to_string(static_cast<int>(y * film.height)) +
                                 ") is more than 45 degrees from that of lens \"" + camera.lens.name +
                                 "\"; expected a lens that sees this film with a more similar projection");
            node.direction = node.lens.direction;  // beyond what the picture shows
        }
    });
    const auto float2 = [](double x, double y) { return Vec2f{static_cast<float>(x), static_cast<float>(y)}; };
    const Vec3d centre_mm = centre_of_projection_mm(camera);
    const double cell_x = (1 + 2 * geometry.margin) * film.width_mm / columns,
                 cell_y = (1 + 2 * geometry.margin) * film.height_mm / rows;
    nodes_.resize(all.size());
    derivatives_.resize(all.size());
    tracer.for_each(rows + 1, [&](int row) {
        for (int column = 0; column <= columns; ++column) {
            const Node& node = node_at(column, row);
            const int left = std::max(column - 1, 0), right = std::min(column + 1, columns), top = std::max(row - 1, 0),
                      bottom = std::min(row + 1, rows);
            // Film x decreases from column to column, and film y increases from row to row.
            const Node along_x[2] = {node_at(right, row), node_at(left, row)},
                       along_y[2] = {node_at(column, top), node_at(column, bottom)};
            const Matrix2 matrix = landing_matrix(node, along_x, along_y);
            // In cells, x and y may have different lengths.
            const double x_over_y = cell_x * (right - left) / (cell_y * (bottom - top));
            const auto index = static_cast<std::size_t>(&node - all.data());
            const Vec3f rotation = static_cast<Vec3f>(cross(node.lens.direction, node.direction)),
                        foot = static_cast<Vec3f>(0.001 * node.lens.foot);
            const float gain = geometry.gain.empty() ? 1.0f : geometry.gain[index];
            nodes_[index] = {{rotation.x, rotation.y, rotation.z, foot.x, foot.y, foot.z, gain, 0}};
            derivatives_[index] = {float2(matrix.first.x, matrix.second.x / x_over_y),
                                   float2(matrix.first.y * x_over_y, matrix.second.y)};
        }
    });
    for (const Vec2f at : geometry.inverse.positions) {
        const Vec2<double> point = film_of(static_cast<double>(at.x), static_cast<double>(at.y));
        positions_.push_back(float2(point.x, point.y));
    }
    const Vec2<double> first = film_of(-geometry.margin, -geometry.margin), mask_first = film_of(0, 0);
    view_.columns = columns;
    view_.rows = rows;
    view_.first = float2(first.x, first.y);
    view_.cells_per_mm = float2(-1 / cell_x, 1 / cell_y);
    view_.mask_columns = geometry.mask.columns;
    view_.mask_rows = geometry.mask.rows;
    view_.mask_first = float2(mask_first.x, mask_first.y);
    view_.mask_cells_per_mm = float2(-geometry.mask.columns / film.width_mm, geometry.mask.rows / film.height_mm);
    view_.side = geometry.inverse.side;
    view_.max_angle = static_cast<float>(geometry.inverse.max_angle);
    view_.centre = static_cast<Vec3f>(0.001 * centre_mm);
}

BundleMotionsView BundleMotions::view() const {
    BundleMotionsView view = view_;
    view.nodes = nodes_.data();
    view.derivatives = derivatives_.data();
    view.defined = geometry_->mask.cells.empty() ? nullptr : geometry_->mask.cells.data();
    view.positions = positions_.data();
    return view;
}

}  // namespace realcam
