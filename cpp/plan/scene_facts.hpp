#pragma once
#include <cmath>
#include <vector>

#include "../math/hypotenuse.hpp"
#include "../math/vec3.hpp"

namespace REALCAM_NAMESPACE {

/// What a tile of the film sees.
struct SeenTile {
    double depth_mm;  ///< along the axis from the front vertex; infinite: nothing is there
    double value;  ///< luminance of the developed picture, 1: white; more than that where it is too bright
    double motion_px;  ///< by which it moves on the film while a pixel is exposed
};

/// What the camera would see far beyond its frame, in squares about the axis of the lens.
struct WideView {
    int side = 0;  ///< squares of a row
    double half_slope = 0;  ///< of the direction of its edges
    std::vector<double> values;  ///< as those of tiles

    /// Over the directions about the axis up to a slope.
    double mean_within(double slope) const {
        double sum = 0, count = 0;
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) {
                const double scale = 2 * half_slope / side, away = 0.5 * (side - 1);
                // Those that it just touches count, so that there is always one.
                if (hypotenuse(x - away, y - away) * scale > slope + scale) continue;
                sum += values[static_cast<std::size_t>(y * side + x)];
                ++count;
            }
        return count > 0 ? sum / count : 0;
    }
};

/// A light that is small, as the camera sees it.
struct SeenLight {
    Vec3d from;  ///< unit, towards the light, in the axes of the lens
    double illuminance_lux;  ///< across that direction, at the lens
    double distance_m;       ///< infinite: a sun's
    double solid_angle_sr;   ///< 0: without any size, so that no ray from the film meets it

    bool is_point() const { return solid_angle_sr == 0; }
};

/// A scene as one camera sees it: all that the planner knows of it.
struct SceneFacts {
    int columns = 0, rows = 0;
    std::vector<SeenTile> tiles;  ///< row by row
    std::vector<SeenLight> lights;  ///< the brightest first
    WideView surroundings;

    const SeenTile& tile_at(double across, double down) const {
        const auto place = [](double share, int count) {
            const int at = static_cast<int>(share * count);
            return static_cast<std::size_t>(at < 0 ? 0 : at < count ? at : count - 1);
        };
        return tiles[place(down, rows) * static_cast<std::size_t>(columns) + place(across, columns)];
    }
};

}  // namespace REALCAM_NAMESPACE
