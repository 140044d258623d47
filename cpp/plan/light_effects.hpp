#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "../camera/camera.hpp"
#include "../optics/axial_share.hpp"
#include "../optics/ghost.hpp"
#include "../optics/transmission.hpp"
#include "picture_codes.hpp"
#include "scene_facts.hpp"

namespace REALCAM_NAMESPACE {

// By how much ghosts, coatings and the edges of the aperture change codes of the developed picture, from closed forms.

namespace light_effects_detail {

inline constexpr double kGreen_mm = 550e-6;

inline double brightest(const SceneFacts& facts) {
    double most = 0;
    for (const SeenTile& tile : facts.tiles) most = std::max(most, tile.value);
    return most;
}

/// Where light that is added shows most.
inline double darkest(const SceneFacts& facts) {
    double least = brightest(facts);
    for (const SeenTile& tile : facts.tiles) least = std::min(least, tile.value);
    return least;
}

inline double mean_value(const SceneFacts& facts) {
    double sum = 0;
    for (const SeenTile& tile : facts.tiles) sum += tile.value;
    return sum / static_cast<double>(facts.tiles.size());
}

/// Of an irradiance on the film, lux.
inline double value_of(const Camera& camera, double lux) {
    return sensor_value(lux * camera.exposure_time_s, camera.iso);
}

/// Whether its image lies on the film or not farther beside it than that is wide.
inline bool is_near_frame(const Camera& camera, const SeenLight& light, double margin) {
    if (!(light.from.z < 0)) return false;
    const double f = std::fabs(first_order(camera.lens, camera.lens.wavelength_nm).effective_focal_length);
    const double x = f * light.from.x / -light.from.z, y = f * light.from.y / -light.from.z;
    return std::fabs(x) < margin * camera.film.width_mm / 2 && std::fabs(y) < margin * camera.film.height_mm / 2;
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
    GhostPair pair{-1, -1};
};

/// Of the lights, by first order: light of a pencil of height h fills a disc of |film distance - back focal distance| /
/// |focal length| times h, about the ghost's image of the lamp. And the veil that all ghosts make of what the film
/// sees. Over the darkest part of the picture.
inline BrightestGhost ghost_codes(const Camera& camera, const SceneFacts& facts) {
    using namespace light_effects_detail;
    const LensSystem& lens = camera.lens;
    const double radius = 0.5 * first_order(lens, lens.wavelength_nm).entrance_pupil_diameter;
    const double pixel = camera.film.width_mm / camera.film.width;
    std::vector<SeenLight> lights;  // that ghosts may come from
    for (const SeenLight& light : facts.lights)
        if (is_near_frame(camera, light, 3)) lights.push_back(light);
    BrightestGhost brightest_ghost;
    double brightest_value = 0, veil = 0;
    for (const GhostPair pair : ghost_pairs(lens)) {
        const GhostPath path = ghost_path(lens, lens.wavelength_nm, pair);
        const double share = axial_share(lens, crossings_of(lens, pair), lens.wavelength_nm);
        const double growth = std::fabs((lens.film_distance - path.back_focal_distance) / path.effective_focal_length);
        // A disc that is larger than the film lights it with what falls in.
        const double disc = std::max(growth * radius, pixel / 2);
        double lux = 0;
        for (const SeenLight& light : lights) {
            const double image = light.solid_angle_sr * path.effective_focal_length * path.effective_focal_length;
            const double pencil = std::numbers::pi * radius * radius, area = std::numbers::pi * disc * disc + image;
            lux += light.illuminance_lux * -light.from.z * share * pencil / area;
        }
        const double value = value_of(camera, lux);
        veil += share * std::min(1.0, 1 / (growth * growth)) * mean_value(facts);
        if (value > brightest_value) {
            brightest_value = value;
            brightest_ghost.pair = pair;
        }
    }
    const double dark = darkest(facts);
    brightest_ghost.codes = code_of(dark + brightest_value + veil) - code_of(dark);
    return brightest_ghost;
}

/// Two pixels beside bright things, over the darkest part of the picture: a point's, whose spread falls with the third
/// power of the distance, and an edge's, with the first (the mean over all directions; docs/diffraction.md).
inline double starburst_codes(const Camera& camera, const SceneFacts& facts) {
    using namespace light_effects_detail;
    const LensSystem& lens = camera.lens;
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    const double spread = kGreen_mm * data.f_number / std::pow(std::numbers::pi, 3);
    const double away = 2 * camera.film.width_mm / camera.film.width;
    const double radius = 0.5 * data.entrance_pupil_diameter;
    double value = 2 * spread / away * std::max(brightest(facts) - 1, 0.0);
    for (const SeenLight& light : facts.lights) {
        if (!light.is_point() || !is_near_frame(camera, light, 1)) continue;
        const double flux = light.illuminance_lux * std::numbers::pi * radius * radius;  // lux mm^2
        value = std::max(value, value_of(camera, flux * spread / (away * away * away)));
    }
    const double dark = darkest(facts);
    return code_of(dark + value) - code_of(dark);
}

/// Diameter of the disc within Airy's first dark ring, in the middle of the film. `film_sine`: see LensErrors.
inline double airy_diameter_px(const Camera& camera, double film_sine) {
    return 1.22 * light_effects_detail::kGreen_mm / film_sine * camera.film.width / camera.film.width_mm;
}

}  // namespace REALCAM_NAMESPACE
