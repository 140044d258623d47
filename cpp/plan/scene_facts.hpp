#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "../camera/film/camera.hpp"
#include "../math/hypotenuse.hpp"
#include "../math/vec3.hpp"

namespace REALCAM_NAMESPACE {

/// Returns the film with at most this many pixels along its longer side.
inline Film with_long_side(Film film, int pixels) {
    const double scale = std::min(1.0, static_cast<double>(pixels) / std::max(film.width, film.height));
    film.width = std::max(1, static_cast<int>(film.width * scale));
    film.height = std::max(1, static_cast<int>(film.height * scale));
    return film;
}

/// View of the scene from one tile of the film.
struct SeenTile {
    double depth_mm;  ///< along the axis from the front vertex; infinite: no surface
    double value;  ///< luminance of the developed picture; 1: white, above 1: overexposed
    double motion_px;  ///< displacement on the film during the exposure of a pixel; NaN: it leaves the image circle
};

/// View far beyond the frame of the camera, as a square grid about the axis of the lens.
struct WideView {
    int side = 0;  ///< number of squares in a row
    double half_slope = 0;  ///< slope of the directions at its edges
    std::vector<double> values;  ///< as in SeenTile, row by row

    /// Mean value over the directions about the axis up to a slope.
    double mean_within(double slope) const {
        double sum = 0, count = 0;
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) {
                const double scale = 2 * half_slope / side, away = 0.5 * (side - 1);
                // Squares that the cone only touches count, so that there is always one.
                if (hypotenuse(x - away, y - away) * scale > slope + scale) continue;
                sum += values[static_cast<std::size_t>(y * side + x)];
                ++count;
            }
        return count > 0 ? sum / count : 0;
    }
};

/// Light of small size as seen by the camera.
struct SeenLight {
    Vec3d from;  ///< unit, towards the light, in the axes of the lens
    double illuminance_lux;  ///< across that direction, at the lens
    double distance_m;       ///< infinite for a sun
    double solid_angle_sr;   ///< 0: a point, which no ray from the film hits

    bool is_point() const { return solid_angle_sr == 0; }
};

/// A scene as seen by one camera: all that the planner knows about it.
struct SceneFacts {
    int columns = 0, rows = 0;
    std::vector<SeenTile> tiles;  ///< row by row
    std::vector<SeenLight> lights;  ///< the brightest first
    WideView surroundings;

    const SeenTile& tile_at(double across, double down) const {
        const auto tile_index = [](double share, int count) {
            const int at = static_cast<int>(share * count);
            return static_cast<std::size_t>(at < 0 ? 0 : at < count ? at : count - 1);
        };
        return tiles[tile_index(down, rows) * static_cast<std::size_t>(columns) + tile_index(across, columns)];
    }
};

}  // namespace REALCAM_NAMESPACE
