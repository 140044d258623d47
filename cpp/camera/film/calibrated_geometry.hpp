#pragma once
#include <cstdint>
#include <vector>

#include "../../math/lanes.hpp"
#include "../../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Geometry of a calibrated camera: the direction that each point of the picture sees from the camera's centre of
/// projection. It replaces that of the lens, whose chief rays are moved onto these directions (BundleMotions).
///
/// Grids over the picture have uniform steps and extend beyond it by `margin`, a fraction of its size, on every side,
/// because light near the picture's edges is interpolated. Values are in the order of the picture: row by row, from the
/// upper left corner.
struct CalibratedGeometry {
    /// The film for which the geometry was computed, mm (see Film). A film of another size or shift sees other
    /// directions.
    double film_width_mm = 0, film_height_mm = 0;
    Vec2<double> film_shift_mm = {0, 0};

    double margin = 0;
    int columns = 0, rows = 0;  ///< number of cells of the grid of directions, including the margin
    /// Unit vectors at the (rows + 1) * (columns + 1) nodes, in the axes of the camera: x right, y up, z backward.
    /// Continued smoothly where the calibration has no ray.
    std::vector<Vec3d> directions;
    /// Factor of the irradiance at each node of the same grid; empty: 1 everywhere.
    std::vector<float> gain;

    /// Cells of the picture, without the margin, in which the calibration has a ray (1) or none (0): these are black.
    struct Mask {
        int columns = 0, rows = 0;
        std::vector<std::uint8_t> cells;  ///< empty: it has a ray everywhere

        bool operator==(const Mask&) const = default;
    } mask;

    /// Grid that inverts `directions`. The direction at an angle a to the forward axis has the coordinates a /
    /// max_angle
    /// * (cos p, sin p), with the azimuth p from x to y. They lie in [-1, 1]^2, row by row from (-1, -1).
    struct Inverse {
        int side = 0;  ///< number of nodes along a side
        double max_angle = 0;  ///< rad; for larger angles, the border of the grid is used
        /// Picture coordinates of each direction: (0, 0) is the upper left corner and (1, 1) the lower right one.
        std::vector<Vec2f> positions;

        bool operator==(const Inverse&) const = default;
    } inverse;

    /// Pinhole camera that agrees with the calibration near the axis, for a picture of the size 1 x 1.
    struct Pinhole {
        double focal_x = 1, focal_y = 1, skew = 0, centre_x = 0.5, centre_y = 0.5;

        bool operator==(const Pinhole&) const = default;
    } pinhole;

    /// Direction at a point of the picture, in picture coordinates: linearly interpolated, a unit vector.
    Vec3d direction_at(Vec2<double> point) const;

    bool operator==(const CalibratedGeometry&) const = default;
};

struct Film;

/// Throws InputError if a number is out of range or the arrays do not have the sizes stated.
void validate(const CalibratedGeometry& geometry);

/// Throws InputError if the film is not that of the geometry. Its resolution may differ.
void check_film(const CalibratedGeometry& geometry, const Film& film);

}  // namespace REALCAM_NAMESPACE
