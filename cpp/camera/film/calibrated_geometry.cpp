#include "calibrated_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "camera.hpp"

namespace realcam {
namespace {

constexpr int kMaxSide = 4096;  ///< largest number of cells along a side of a grid

void require(bool is_valid, const char* what) {
    if (!is_valid) throw InputError(std::string("calibrated geometry: expected ") + what);
}

std::size_t product(int a, int b) {
    return static_cast<std::size_t>(a) * static_cast<std::size_t>(b);
}

}  // namespace

Vec3d CalibratedGeometry::direction_at(Vec2<double> point) const {
    const auto position = [&](double coordinate, int cells) {
        return std::clamp((coordinate + margin) / (1 + 2 * margin) * cells, 0.0, static_cast<double>(cells));
    };
    const double column = position(point.x, columns), row = position(point.y, rows);
    const int left = std::min(static_cast<int>(column), columns - 1), top = std::min(static_cast<int>(row), rows - 1);
    const auto node = [&](int right, int down) {
        return directions[product(top + down, columns + 1) + static_cast<std::size_t>(left + right)];
    };
    const double x = column - left, y = row - top;
    return normalized((1 - y) * ((1 - x) * node(0, 0) + x * node(1, 0)) + y * ((1 - x) * node(0, 1) + x * node(1, 1)));
}

void validate(const CalibratedGeometry& geometry) {
    const auto is_side = [](int count, int least) { return count >= least && count <= kMaxSide; };
    require(geometry.margin >= 0 && geometry.margin <= 1, "a margin from 0 to 1");
    require(is_side(geometry.columns, 1) && is_side(geometry.rows, 1), "1 to 4096 columns and rows");
    const std::size_t nodes = product(geometry.columns + 1, geometry.rows + 1);
    require(geometry.directions.size() == nodes, "a direction for each node");
    const auto is_unit = [](Vec3d v) { return std::fabs(dot(v, v) - 1) < 1e-6; };  // false for NaN
    require(std::all_of(geometry.directions.begin(), geometry.directions.end(), is_unit), "unit vectors as directions");
    require(geometry.gain.empty() || geometry.gain.size() == nodes, "a gain for each node, or none");
    const auto is_gain = [](float gain) { return gain >= 0 && std::isfinite(gain); };
    require(std::all_of(geometry.gain.begin(), geometry.gain.end(), is_gain), "gains of 0 or more");
    if (!geometry.mask.cells.empty()) {
        require(is_side(geometry.mask.columns, 1) && is_side(geometry.mask.rows, 1),
                "a mask of 1 to 4096 cells a side");
        require(geometry.mask.cells.size() == product(geometry.mask.columns, geometry.mask.rows),
                "a value for each cell of the mask");
    }
    require(is_side(geometry.inverse.side, 2) &&
                geometry.inverse.positions.size() == product(geometry.inverse.side, geometry.inverse.side),
            "a position for each direction");
    require(geometry.inverse.max_angle > 0 && geometry.inverse.max_angle <= std::numbers::pi,
            "a largest angle from 0 to 180 degrees");
    const auto is_finite = [](Vec2f p) { return std::isfinite(p.x) && std::isfinite(p.y); };
    require(std::all_of(geometry.inverse.positions.begin(), geometry.inverse.positions.end(), is_finite),
            "finite positions");
    require(geometry.pinhole.focal_x > 0 && geometry.pinhole.focal_y > 0 &&
                std::isfinite(geometry.pinhole.focal_x + geometry.pinhole.focal_y) &&
                std::isfinite(geometry.pinhole.skew + geometry.pinhole.centre_x + geometry.pinhole.centre_y),
            "positive focal lengths and a finite centre");
}

void check_film(const CalibratedGeometry& geometry, const Film& film) {
    if (geometry.film_width_mm != film.width_mm || geometry.film_height_mm != film.height_mm ||
        geometry.film_shift_mm != film.shift_mm)
        throw InputError(
            "the camera's geometry is that of a calibration for a film of another size or shift; create the camera "
            "from the calibration (Calibration.camera)");
}

}  // namespace realcam
