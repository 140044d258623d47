#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "../camera/film/camera.hpp"
#include "../math/hypotenuse.hpp"
#include "../math/vec3.hpp"

namespace REALCAM_NAMESPACE {

// Facts about a scene on which the planner decides: a small picture of it and its lights (probe_scene.hpp).

/// Returns the film with at most this many pixels along its longer side.
inline Film with_long_side(Film film, int pixels) {
    const double scale = std::min(1.0, static_cast<double>(pixels) / std::max(film.width, film.height));
    film.width = std::max(1, static_cast<int>(film.width * scale));
    film.height = std::max(1, static_cast<int>(film.height * scale));
    return film;
}

/// View of the scene from one tile of the film: a pixel of a small picture.
struct SceneTile {
    double depth_mm;  ///< along the axis from the front vertex; infinite: no surface
    double value;  ///< linear luminance of the developed picture; 1: white, above 1: overexposed
    double motion_px;  ///< displacement on the film, in pixels of the planned picture, during the exposure of a pixel;
                       ///< NaN: it leaves the image circle
};

/// View far beyond the frame of the camera, as a square grid about the axis of the lens.
struct WideView {
    int side = 0;  ///< number of squares in a row and in a column
    double half_slope = 0;  ///< tangent of the angle between the axis and the directions at its edges
    std::vector<double> values;  ///< SceneTile::value of each square, row by row

    /// Mean value over the directions whose angle to the axis has at most the tangent `slope`.
    double mean_within(double slope) const {
        double sum = 0, count = 0;
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) {
                const double scale = 2 * half_slope / side, centre = 0.5 * (side - 1);
                // Squares that the cone only touches count, so that there is always one.
                if (hypotenuse(x - centre, y - centre) * scale > slope + scale) continue;
                sum += values[static_cast<std::size_t>(y * side + x)];
                ++count;
            }
        return count > 0 ? sum / count : 0;
    }
};

/// Light of small size as seen by the camera.
struct VisibleLight {
    Vec3d from;  ///< unit vector towards the light, in the axes of the lens
    double illuminance_lux;  ///< at the lens, on a plane perpendicular to that direction
    double distance_m;  ///< infinite for a sun
    double solid_angle_sr;  ///< 0: a point, which no ray from the film hits

    bool is_point() const { return solid_angle_sr == 0; }
};

/// A scene as seen by one camera: all that the planner knows about it.
struct SceneFacts {
    int columns = 0, rows = 0;  ///< number of tiles across and down
    std::vector<SceneTile> tiles;  ///< row by row
    std::vector<VisibleLight> lights;  ///< the brightest first
    WideView surroundings;  ///< view beyond the frame, from which ghosts receive light

    /// Tile at a point given in fractions of the picture's width and height; points outside give the nearest tile.
    const SceneTile& tile_at(double across, double down) const {
        const auto tile_index = [](double fraction, int count) {
            const int index = static_cast<int>(fraction * count);
            return static_cast<std::size_t>(index < 0 ? 0 : index < count ? index : count - 1);
        };
        return tiles[tile_index(down, rows) * static_cast<std::size_t>(columns) + tile_index(across, columns)];
    }
};

}  // namespace REALCAM_NAMESPACE
