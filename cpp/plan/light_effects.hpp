#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "../camera/camera.hpp"
#include "../camera/picture_codes.hpp"
#include "../optics/axial_share.hpp"
#include "../optics/ghost.hpp"
#include "../optics/transmission.hpp"
#include "scene_facts.hpp"

namespace REALCAM_NAMESPACE {

// By how much ghosts, coatings and the edges of the aperture change codes of the developed picture, from closed forms.

namespace light_effects_detail {

inline constexpr double kGreen_mm = 550e-6;

/// Of an irradiance on the film, lux.
inline double value_of(const Camera& camera, double lux) {
    return sensor_value(lux * camera.exposure_time_s, camera.iso);
}

inline double codes_between(double dark, double added) {
    return code_of(dark + added) - code_of(dark);
}

/// Where the light of a slope would be without a lens's errors, or on the axis for slope 0, in shares of the picture.
struct PicturePlace {
    double across, down;
};

inline PicturePlace place_of(const Camera& camera, double film_x, double film_y) {
    return {0.5 - film_x / camera.film.width_mm, 0.5 + film_y / camera.film.height_mm};
}

/// The darkest tile within a disc of the picture; nothing where none is.
inline std::optional<double> darkest_within(const SceneFacts& facts, PicturePlace place, double radius_across,
                                            double radius_down) {
    const auto range = [](double middle, double radius, int count) {
        const auto bounded = [&](double share) {
            return static_cast<int>(std::clamp(std::floor(share * count), -1.0, static_cast<double>(count)));
        };
        return std::pair(std::max(0, bounded(middle - radius)), std::min(count - 1, bounded(middle + radius)));
    };
    const auto [first_column, last_column] = range(place.across, radius_across, facts.columns);
    const auto [first_row, last_row] = range(place.down, radius_down, facts.rows);
    std::optional<double> least;
    for (int row = first_row; row <= last_row; ++row)
        for (int column = first_column; column <= last_column; ++column) {
            const double value = facts.tiles[static_cast<std::size_t>(row * facts.columns + column)].value;
            least = std::min(least.value_or(value), value);
        }
    return least;
}

/// Beside a place of the picture.
inline std::optional<double> darkest_beside(const SceneFacts& facts, PicturePlace place) {
    return darkest_within(facts, place, 1.0 / facts.columns, 1.0 / facts.rows);
}

/// So many that one of them brings what shows most.
inline std::vector<SeenLight> brightest_in_front(const SceneFacts& facts) {
    constexpr std::size_t kMost = 16;
    std::vector<SeenLight> lights;
    for (const SeenLight& light : facts.lights)
        if (light.from.z < 0 && lights.size() < kMost) lights.push_back(light);
    return lights;
}

inline double brightest(const SceneFacts& facts) {
    double most = 0;
    for (const SeenTile& tile : facts.tiles) most = std::max(most, tile.value);
    return most;
}

/// What light from everywhere brings by a pair of surfaces, as the value of the picture.
///
/// Light that comes together on the film with the sine s makes pi L s^2 of the radiance L there, and comes from
/// directions about the axis whose pencils are as wide as the ghost's disc. s is that of the ghost's image of the
/// entrance pupil, or of the last rim where it is narrower.
inline double veil_of(const LensSystem& lens, const FirstOrder& data, const GhostPath& path, double growth,
                      const WideView& seen) {
    const double radius = 0.5 * data.entrance_pupil_diameter, f = std::fabs(data.effective_focal_length);
    const double rim = lens.surfaces.back().clear_semi_diameter;
    const double widest = rim / std::hypot(rim, lens.film_distance);
    const double slope = radius * std::fabs(path.of_height.slope);
    const double sine = std::min(slope, widest), of_lens = std::min(radius / f, 1.0);
    return (sine / of_lens) * (sine / of_lens) * seen.mean_within(growth * slope);
}

}  // namespace light_effects_detail

/// What the surfaces keep, where the picture is brightest without being clipped.
inline double coating_codes(const Camera& camera, const SceneFacts& facts) {
    const double value = std::min(light_effects_detail::brightest(facts), 1.0);
    return code_of(value) - code_of(value * axial_transmittance(camera.lens, camera.lens.wavelength_nm));
}

/// A ghost and how bright it may be.
struct BrightestGhost {
    double codes = 0;
    GhostPair pair{-1, -1};  ///< none: it is the veil of all
};

/// By first order. The light of a lamp fills a disc about where the chief ray meets the film; where the picture is darkest in it, it shows most. The veil that
/// all ghosts make of what the lens sees shows most where the picture is darkest.
inline BrightestGhost ghost_codes(const Camera& camera, const SceneFacts& facts) {
    using namespace light_effects_detail;
    const LensSystem& lens = camera.lens;
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    const double radius = 0.5 * data.entrance_pupil_diameter;
    const double pixel = camera.film.width_mm / camera.film.width;
    const std::vector<SeenLight> lights = brightest_in_front(facts);
    struct Spot {
        GhostPair pair;
        double value, dark;
    };
    std::vector<Spot> spots;
    double veil = 0;
    for (const GhostPair pair : ghost_pairs(lens)) {
        const GhostPath path = ghost_path(lens, lens.wavelength_nm, pair);
        const double share = axial_share(lens, crossings_of(lens, pair), lens.wavelength_nm);
        const auto on_film = [&](const ParaxialRay& ray) { return ray.height + lens.film_distance * ray.slope; };
        const double growth = std::fabs(on_film(path.of_height));
        veil += share * veil_of(lens, data, path, growth, facts.surroundings);
        const double chief = on_film(path.of_slope) - data.entrance_pupil_position * on_film(path.of_height);
        for (const SeenLight& light : lights) {
            const double image = light.solid_angle_sr * chief * chief;
            const double disc = std::sqrt(std::max(growth * growth * radius * radius, pixel * pixel / 4) +
                                          image / std::numbers::pi);
            const PicturePlace place =
                place_of(camera, chief * light.from.x / light.from.z, chief * light.from.y / light.from.z);
            const auto dark =
                darkest_within(facts, place, disc / camera.film.width_mm, disc / camera.film.height_mm);
            if (!dark) continue;
            const double lux =
                light.illuminance_lux * -light.from.z * share * radius * radius / (disc * disc);
            spots.push_back({pair, value_of(camera, lux), *dark});
        }
    }
    double darkest = brightest(facts);
    for (const SeenTile& tile : facts.tiles) darkest = std::min(darkest, tile.value);
    BrightestGhost most{codes_between(darkest, veil)};
    for (const Spot& spot : spots) {
        const double codes = codes_between(spot.dark, spot.value + veil);
        if (codes > most.codes) most = {codes, spot.pair};
    }
    return most;
}

/// Two pixels beside bright things: a point's, whose spread falls with the third power of the distance, and an edge's,
/// with the first (the mean over all directions; docs/diffraction.md). Where the picture beside them is darkest.
inline double starburst_codes(const Camera& camera, const SceneFacts& facts) {
    using namespace light_effects_detail;
    const LensSystem& lens = camera.lens;
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    const double spread = kGreen_mm * data.f_number / std::pow(std::numbers::pi, 3);
    const double away = 2 * camera.film.width_mm / camera.film.width;
    const double radius = 0.5 * data.entrance_pupil_diameter;
    double codes = 0;
    const auto add = [&](PicturePlace place, double value) {
        if (const auto dark = darkest_beside(facts, place)) codes = std::max(codes, codes_between(*dark, value));
    };
    for (int row = 0; row < facts.rows; ++row)
        for (int column = 0; column < facts.columns; ++column) {
            const double over = facts.tiles[static_cast<std::size_t>(row * facts.columns + column)].value - 1;
            if (over > 0) add({(column + 0.5) / facts.columns, (row + 0.5) / facts.rows}, 2 * spread / away * over);
        }
    for (const SeenLight& light : brightest_in_front(facts)) {
        if (!light.is_point()) continue;
        const double f = data.effective_focal_length;
        const double flux = light.illuminance_lux * std::numbers::pi * radius * radius;  // lux mm^2
        add(place_of(camera, f * light.from.x / light.from.z, f * light.from.y / light.from.z),
            value_of(camera, flux * spread / (away * away * away)));
    }
    return codes;
}

/// Diameter of the disc within Airy's first dark ring, in the middle of the film. `film_sine`: see LensErrors.
inline double airy_diameter_px(const Camera& camera, double film_sine) {
    return 1.22 * light_effects_detail::kGreen_mm / film_sine * camera.film.width / camera.film.width_mm;
}

}  // namespace REALCAM_NAMESPACE
