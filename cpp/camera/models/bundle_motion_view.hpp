#pragma once
#include <cstdint>

#include "../../math/lanes.hpp"

namespace REALCAM_NAMESPACE {

// Bundles of rays in front of a calibrated camera. Each film point keeps the bundle of the lens, with its blur, colours
// and vignetting, but the bundle is moved as a rigid body: its chief ray then passes through the centre of projection
// of the calibration, in the calibrated direction. The picture's geometry is thus that of the calibration at every
// distance. (The lens's own chief rays do not meet in one point.)
//
// All vectors are in the axes of the camera (x right, y up, z backward), points in metres from the centre of the
// unshifted film.

/// Motion of the bundle of a film point, from the lens to the scene. Its numbers are one vector, so that the table is
/// interpolated by few loads: one for a node on a processor with AVX, and two on a GPU.
struct alignas(32) BundleMotion {
    static constexpr int kNumbers = 8;

    float numbers[kNumbers];  ///< rotation, foot, gain, and 0

    /// Axis times the sine of the angle, which is below 90 degrees.
    REALCAM_INLINE Vec3f rotation() const { return {numbers[0], numbers[1], numbers[2]}; }
    /// Point of the lens's chief ray that moves to the centre of projection.
    REALCAM_INLINE Vec3f foot() const { return {numbers[3], numbers[4], numbers[5]}; }
    /// Factor of the irradiance.
    REALCAM_INLINE float gain() const { return numbers[6]; }
};

/// Derivatives, by x and y, of the film point that sees a given scene point, when the film point on which the lens with
/// a fixed motion images the scene point changes: (1, 0) and (0, 1) if the calibration is the lens's own geometry.
struct LandingDerivatives {
    Vec2f by_x, by_y;

    REALCAM_INLINE Vec2f of(Vec2f shift) const {
        return {shift.x * by_x.x + shift.y * by_y.x, shift.x * by_x.y + shift.y * by_y.y};
    }
    /// Area on which light falls in the picture over that behind the lens.
    REALCAM_INLINE float area() const { return std::fabs(by_x.x * by_y.y - by_x.y * by_y.x); }
};

/// Table of the motions over the film. Film points in mm.
struct BundleMotionsView {
    const BundleMotion* nodes;  ///< (rows + 1) * (columns + 1); null: the camera is not calibrated
    const LandingDerivatives* derivatives;  ///< at the nodes
    int columns, rows;  ///< number of cells
    Vec2f first, cells_per_mm;  ///< film point of the first node; negative steps where the film's axis is reversed
    const std::uint8_t* defined;  ///< see CalibratedGeometry; null: defined everywhere
    int mask_columns, mask_rows;
    Vec2f mask_first, mask_cells_per_mm;
    const Vec2f* positions;  ///< film points of directions, side * side (CalibratedGeometry::positions)
    int side;
    float max_angle;
    Vec3f centre;  ///< centre of projection
};

namespace bundle_motion_detail {

/// Position in a grid: a cell, and fractions of its width and height.
struct GridCell {
    int index;  ///< index of the cell's first node
    float x, y;
};

/// `column`, `row`: position in cells, limited to the grid.
REALCAM_INLINE GridCell grid_cell(float column, float row, int columns, int rows) {
    const auto limited = [](float value, int cells) {
        const float positive = select(value > 0.0f, value, 0.0f), most = static_cast<float>(cells);
        return select(positive < most, positive, most);
    };
    const float c = limited(column, columns), r = limited(row, rows);
    int left = static_cast<int>(c), top = static_cast<int>(r);
    left = select(left < columns, left, columns - 1);
    top = select(top < rows, top, rows - 1);
    return {top * (columns + 1) + left, c - static_cast<float>(left), r - static_cast<float>(top)};
}

/// Bilinear interpolation of `value_of(node)`. `stride`: number of nodes in a row.
template <class Node, class ValueOf>
REALCAM_INLINE auto interpolated(const Node* nodes, int stride, GridCell cell, ValueOf&& value_of) {
    const Node* top = nodes + cell.index;
    const Node* bottom = top + stride;
    const float x = cell.x, y = cell.y, u = 1.0f - x, v = 1.0f - y;
    return (v * u) * value_of(top[0]) + (v * x) * value_of(top[1]) + (y * u) * value_of(bottom[0]) +
           (y * x) * value_of(bottom[1]);
}

REALCAM_INLINE GridCell cell_of(const BundleMotionsView& view, Vec2f film) {
    return grid_cell((film.x - view.first.x) * view.cells_per_mm.x, (film.y - view.first.y) * view.cells_per_mm.y,
                     view.columns, view.rows);
}

}  // namespace bundle_motion_detail

/// Motion of the bundle of a film point in a cell of the table.
REALCAM_INLINE BundleMotion motion_in_cell(const BundleMotionsView& view, bundle_motion_detail::GridCell cell) {
    const BundleMotion* const top = view.nodes + cell.index;
    const BundleMotion* const bottom = top + view.columns + 1;
    const float x = cell.x, y = cell.y, u = 1.0f - x, v = 1.0f - y;
    const float weights[] = {v * u, v * x, y * u, y * x};
    // Copies of whole nodes, because only these are loaded as vectors on a GPU. With indices in place of the pointers,
    // gcc would vectorise over the lanes of a block, and gather each number by itself.
    const BundleMotion corners[] = {top[0], top[1], bottom[0], bottom[1]};
    BundleMotion motion;
    for (int k = 0; k < BundleMotion::kNumbers; ++k)
        motion.numbers[k] = weights[0] * corners[0].numbers[k] + weights[1] * corners[1].numbers[k] +
                            weights[2] * corners[2].numbers[k] + weights[3] * corners[3].numbers[k];
    return motion;
}

/// Motion of the bundle of a film point; that of the nearest one of the table beyond its border.
REALCAM_INLINE BundleMotion bundle_motion(const BundleMotionsView& view, Vec2f film) {
    return motion_in_cell(view, bundle_motion_detail::cell_of(view, film));
}

/// True if the calibration has a ray at a film point. Beyond the picture's edges: as at the edge.
REALCAM_INLINE bool is_defined(const BundleMotionsView& view, Vec2f film) {
    if (!view.defined) return true;
    const auto index = [](float position, int cells) {
        const int cell = static_cast<int>(select(position > 0.0f, position, 0.0f));
        return select(cell < cells, cell, cells - 1);
    };
    const int column = index((film.x - view.mask_first.x) * view.mask_cells_per_mm.x, view.mask_columns),
              row = index((film.y - view.mask_first.y) * view.mask_cells_per_mm.y, view.mask_rows);
    return view.defined[row * view.mask_columns + column] != 0;
}

/// Rotates a vector about an axis. `rotation`: the axis times the sine of an angle below 90 degrees (Rodrigues).
template <class R, class T>
REALCAM_INLINE Vec3<T> rotated(Vec3<R> rotation, Vec3<T> v) {
    const auto axis = static_cast<Vec3<T>>(rotation);
    const Vec3<T> across = cross(axis, v);
    const T cosine = sqrt_or_zero(1 - dot(axis, axis));
    return v + across + (1 / (1 + cosine)) * cross(axis, across);
}

/// Moves a point of a lens's ray to where it is in front of the calibrated camera, and back.
template <class T>
REALCAM_INLINE Vec3<T> moved_point(const BundleMotionsView& view, const BundleMotion& motion, Vec3<T> point) {
    return static_cast<Vec3<T>>(view.centre) + rotated(motion.rotation(), point - static_cast<Vec3<T>>(motion.foot()));
}
template <class T>
REALCAM_INLINE Vec3<T> point_before_motion(const BundleMotionsView& view, const BundleMotion& motion, Vec3<T> point) {
    return static_cast<Vec3<T>>(motion.foot()) + rotated(-motion.rotation(), point - static_cast<Vec3<T>>(view.centre));
}

/// Film point, mm, whose chief ray has a direction in front of the calibrated camera: a unit vector. Beyond the table:
/// a film point near its border.
REALCAM_INLINE Vec2f film_point_seeing(const BundleMotionsView& view, Vec3f direction) {
    using namespace bundle_motion_detail;
    const float across = sqrt_or_zero(direction.x * direction.x + direction.y * direction.y);
    const float radius = std::atan2(across, -direction.z) / view.max_angle;
    const float scale = select(across > 0.0f, radius / select(across > 0.0f, across, 1.0f), 0.0f);
    const float half_side = 0.5f * static_cast<float>(view.side - 1);
    const GridCell cell = grid_cell((1.0f + scale * direction.x) * half_side, (1.0f + scale * direction.y) * half_side,
                                    view.side - 1, view.side - 1);
    return {interpolated(view.positions, view.side, cell, [](Vec2f film) { return film.x; }),
            interpolated(view.positions, view.side, cell, [](Vec2f film) { return film.y; })};
}

/// Interpolated derivatives at a film point.
REALCAM_INLINE LandingDerivatives landing_derivatives(const BundleMotionsView& view, Vec2f film) {
    using namespace bundle_motion_detail;
    const GridCell cell = cell_of(view, film);
    const auto at = [&](auto&& value_of) { return interpolated(view.derivatives, view.columns + 1, cell, value_of); };
    return {{at([](const LandingDerivatives& node) { return node.by_x.x; }),
             at([](const LandingDerivatives& node) { return node.by_x.y; })},
            {at([](const LandingDerivatives& node) { return node.by_y.x; }),
             at([](const LandingDerivatives& node) { return node.by_y.y; })}};
}

/// Film point at which light appears in the picture, if the lens, with the motion of the film point `about`, brings it
/// to `landing`: linear in their difference. `area`: see LandingDerivatives.
struct PictureLanding {
    Vec2f film;
    float area;
};

REALCAM_INLINE PictureLanding picture_landing(const BundleMotionsView& view, Vec2f about, Vec2f landing) {
    const LandingDerivatives derivatives = landing_derivatives(view, about);
    const Vec2f shift = derivatives.of({landing.x - about.x, landing.y - about.y});
    return {{about.x + shift.x, about.y + shift.y}, derivatives.area()};
}

}  // namespace REALCAM_NAMESPACE
