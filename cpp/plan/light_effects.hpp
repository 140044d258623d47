#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "../camera/film/camera.hpp"
#include "../camera/film/develop.hpp"
#include "../math/hypotenuse.hpp"
#include "../optics/analysis/transmission.hpp"
#include "../optics/ghost/ghost.hpp"
#include "../optics/lens/exposure.hpp"
#include "scene_facts.hpp"

namespace REALCAM_NAMESPACE {

// Estimates of the changes of the developed picture by coatings, ghosts and diffraction, from closed forms. Changes are
// in codes, 8-bit display values. A developed value is linear, 1 being white.

namespace light_effects_detail {

inline constexpr double kGreen_mm = 550e-6;  ///< wavelength of green light

/// Developed value of an illuminance on the film, lux.
inline double developed_value(const Camera& camera, double lux) {
    return sensor_value(lux * camera.exposure_time_s, camera.iso);
}

/// Change in codes by adding light of the developed value `added` to that of the value `background`.
inline double codes_added(double background, double added) {
    return code_of(background + added) - code_of(background);
}

/// Point of the picture in fractions of its width and height, as imaged by a lens without aberrations.
struct PicturePosition {
    double across, down;
};

/// Position in the picture of a film point, mm, in the axes of the lens.
inline PicturePosition picture_position(const Camera& camera, double film_x, double film_y) {
    const Film& film = camera.film;
    const Vec2<double> pixel = film.pixel_of({-film_x, -film_y});
    return {pixel.x / film.width, pixel.y / film.height};
}

/// Value of the darkest tile around a point, within these radii, as fractions of the picture's width and height.
/// Returns std::nullopt if no tile lies within them.
inline std::optional<double> darkest_within(const SceneFacts& facts, PicturePosition position, double radius_across,
                                            double radius_down) {
    const auto range = [](double middle, double radius, int count) {
        const auto bounded_index = [&](double fraction) {
            return static_cast<int>(std::clamp(std::floor(fraction * count), -1.0, static_cast<double>(count)));
        };
        return std::pair(std::max(0, bounded_index(middle - radius)),
                         std::min(count - 1, bounded_index(middle + radius)));
    };
    const auto [first_column, last_column] = range(position.across, radius_across, facts.columns);
    const auto [first_row, last_row] = range(position.down, radius_down, facts.rows);
    std::optional<double> least;
    for (int row = first_row; row <= last_row; ++row)
        for (int column = first_column; column <= last_column; ++column) {
            const double value = facts.tiles[static_cast<std::size_t>(row * facts.columns + column)].value;
            least = std::min(least.value_or(value), value);
        }
    return least;
}

/// Value of the darkest tile at or next to a point of the picture; std::nullopt if the point lies far outside.
inline std::optional<double> darkest_neighbour(const SceneFacts& facts, PicturePosition position) {
    return darkest_within(facts, position, 1.0 / facts.columns, 1.0 / facts.rows);
}

/// The brightest lights in front of the camera, enough to include the one whose effects are the most visible.
inline std::vector<VisibleLight> brightest_in_front(const SceneFacts& facts) {
    constexpr std::size_t kMaxLights = 16;
    std::vector<VisibleLight> lights;
    for (const VisibleLight& light : facts.lights)
        if (light.from.z < 0 && lights.size() < kMaxLights) lights.push_back(light);
    return lights;
}

/// Value of the brightest tile; 0 without tiles.
inline double brightest_value(const SceneFacts& facts) {
    double largest = 0;
    for (const SceneTile& tile : facts.tiles) largest = std::max(largest, tile.value);
    return largest;
}

/// First-order properties of the light that reaches the film by reflection at a pair of surfaces.
class GhostBundle {
public:
    /// `lens` must outlive the object.
    GhostBundle(const LensSystem& lens, GhostPair pair, double wavelength_nm)
        : lens_(lens),
          path_(ghost_path(lens, wavelength_nm, pair)),
          film_height_per_height_(film_height(path_.of_height)),
          film_height_per_slope_(film_height(path_.of_slope)) {}

    /// Disc of light of a parallel bundle on the film, mm.
    struct Spot {
        double centre;  ///< distance from the axis, signed
        double radius;
        double radius_in_front;  ///< radius of the bundle in front of the lens
    };

    /// Spot of a bundle. `slope`: its slope to the axis in front of the lens. Returns std::nullopt if the rims block
    /// the whole bundle.
    std::optional<Spot> spot_of(double slope) const {
        double low = -kInfinity, high = kInfinity;
        for (const GhostPath::SurfaceHeights& heights : path_.surface_heights) {
            const double middle = -heights.of_slope * slope / heights.of_height;
            const double radius = std::fabs(rim(heights.surface) / heights.of_height);
            low = std::max(low, middle - radius);
            high = std::min(high, middle + radius);
        }
        if (!(high > low)) return {};
        const double radius = (high - low) / 2;
        return Spot{film_height_per_height_ * (low + high) / 2 + film_height_per_slope_ * slope,
                    std::fabs(film_height_per_height_) * radius, radius};
    }

    /// Cone of light that converges on the film centre, limited by the narrowest rim.
    struct Cone {
        double sine;  ///< sine of its half angle at the film
        double slope_in_scene;  ///< slope of its outermost ray in front of the lens
    };

    Cone cone_to_film_centre() const {
        // A ray to the film centre has height and slope in front of the lens in the ratio of these two.
        const double height = film_height_per_slope_, slope = -film_height_per_height_;
        // Largest factor by which this ray can be scaled so that it passes all rims.
        double largest_scale = kInfinity;
        for (const GhostPath::SurfaceHeights& heights : path_.surface_heights)
            largest_scale = std::min(
                largest_scale, rim(heights.surface) / std::fabs(heights.of_height * height + heights.of_slope * slope));
        const double tangent = largest_scale * std::fabs(path_.of_height.slope * height + path_.of_slope.slope * slope);
        return {tangent / hypotenuse(tangent, 1.0), largest_scale * std::fabs(slope)};
    }

private:
    /// Height on the film of a ray behind the last surface, mm.
    double film_height(const ParaxialRay& ray) const { return ray.height + lens_.film_distance * ray.slope; }
    /// Radius within which light passes a surface, mm.
    double rim(int surface) const {
        const double clear = lens_.surfaces[static_cast<std::size_t>(surface)].clear_semi_diameter;
        return surface == lens_.stop_index() ? std::min(clear, lens_.stop_semi_diameter) : clear;
    }

    const LensSystem& lens_;
    GhostPath path_;
    double film_height_per_height_;  ///< change of the height on the film per unit of height in front of the lens
    double film_height_per_slope_;  ///< change of the height on the film per unit of slope in front of the lens, mm
};

/// Centres of the red, green and blue bands.
inline constexpr double kColours_nm[] = {610, 540, 460};
inline constexpr std::size_t kColours = std::size(kColours_nm);

/// Axial transmittances at each of the colours and, last, at the lens's own wavelength, which stands for all colours
/// without dispersion.
inline std::vector<AxialTransmittance> axial_transmittances(const LensSystem& lens) {
    std::vector<AxialTransmittance> transmittances;
    for (const double wavelength_nm : kColours_nm) transmittances.emplace_back(lens, wavelength_nm);
    transmittances.emplace_back(lens, lens.wavelength_nm);
    return transmittances;
}

}  // namespace light_effects_detail

/// Change of the picture by an effect of the lens's surfaces, in codes.
struct LightChange {
    double codes = 0;  ///< in the colour that shows it most
    double colour_codes = 0;  ///< largest difference of a colour from the result with one wavelength for all colours
};

/// Change by the light that is lost at the surfaces, where the picture is brightest without being clipped.
inline LightChange coating_codes(const Camera& camera, const SceneFacts& facts) {
    using namespace light_effects_detail;
    const double value = std::min(brightest_value(facts), 1.0);
    const auto crossings = crossings_of(camera.lens);
    const std::vector<AxialTransmittance> transmittances = axial_transmittances(camera.lens);
    const auto codes_lost = [&](const AxialTransmittance& transmittance) {
        return code_of(value) - code_of(value * transmittance(crossings));
    };
    const double lost_at_one_wavelength = codes_lost(transmittances.back());
    LightChange change;
    for (const AxialTransmittance& transmittance : transmittances) {
        change.codes = std::max(change.codes, codes_lost(transmittance));
        change.colour_codes =
            std::max(change.colour_codes, std::fabs(codes_lost(transmittance) - lost_at_one_wavelength));
    }
    return change;
}

/// Change by ghosts, with the pair of surfaces of the most visible one.
struct GhostChange : LightChange {
    GhostPair brightest{-1, -1};  ///< -1: the veiling glare of all ghosts is the most visible
};

namespace light_effects_detail {

/// Disc on the film that is the ghost of one light, in one colour.
struct GhostDisc {
    double centre;  ///< distance from the film centre in the direction to the light, mm
    double radius;  ///< mm
    double value;  ///< developed value that it adds
    double darkest;  ///< lowest value of the picture without it, within the disc
};

/// Ghost of a light. `bundle`: properties of the ghost path; `transmittance`: fraction of the light that it transmits;
/// `pixel_mm`: pixel pitch. Returns std::nullopt
/// if the rims block the ghost, or it lies outside the frame.
inline std::optional<GhostDisc> ghost_disc(const Camera& camera, const SceneFacts& facts, const GhostBundle& bundle,
                                           const VisibleLight& light, double transmittance, double pixel_mm) {
    const double across = light.from.x / -light.from.z, down = light.from.y / -light.from.z;
    // The position of a ghost is proportional to the slope near the axis; on the axis a small slope avoids 0 / 0.
    const double slope = std::max(hypotenuse(across, down), 1e-6);
    const std::optional<GhostBundle::Spot> spot = bundle.spot_of(slope);
    if (!spot) return {};
    const double chief = spot->centre / slope;  // film height of the ghost per unit of slope, mm
    const double image_area = light.solid_angle_sr * chief * chief;
    const double radius =
        std::sqrt(std::max(spot->radius * spot->radius, pixel_mm * pixel_mm / 4) + image_area / std::numbers::pi);
    const PicturePosition position = picture_position(camera, -chief * across, -chief * down);
    const auto dark = darkest_within(facts, position, radius / camera.film.width_mm, radius / camera.film.height_mm);
    if (!dark) return {};
    const double concentration = spot->radius_in_front / radius;
    const double lux = light.illuminance_lux * -light.from.z * concentration * concentration;
    return GhostDisc{spot->centre, radius, developed_value(camera, transmittance * lux), *dark};
}

/// Difference in codes between a ghost's disc in one colour and `reference`, the disc at the lens's own wavelength: by
/// its light, and in the crescent that only one of the two covers, which may be narrower than a pixel. `veil` and
/// `reference_veil`: developed values of the veiling glare in the two cases; `pixel_mm`: pixel pitch.
inline double colour_difference(const GhostDisc& disc, double veil, const GhostDisc& reference, double reference_veil,
                                double pixel_mm) {
    const double light = std::fabs(codes_added(disc.darkest, disc.value + veil) -
                                   codes_added(disc.darkest, reference.value + reference_veil));
    const double crescent_mm = std::fabs(disc.centre - reference.centre) + std::fabs(disc.radius - reference.radius);
    return std::max(light, codes_added(disc.darkest, std::min(crescent_mm / pixel_mm, 1.0) * reference.value));
}

}  // namespace light_effects_detail

/// Changes by ghosts, to first order, in the colour that shows them most. The ghost of a light fills a disc and is the
/// most visible where the picture is darkest within it. The veiling glare, the sum of all ghosts of the scene, is the
/// most visible where the picture is darkest. Light of radiance L that converges on the film with the sine s has the
/// irradiance pi L s^2.
inline GhostChange ghost_codes(const Camera& camera, const SceneFacts& facts) {
    using namespace light_effects_detail;
    const LensSystem& lens = camera.lens;
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    const double f = std::fabs(data.effective_focal_length);
    const double sine_of_lens = std::min(0.5 * data.entrance_pupil_diameter / f, 1.0);
    const double pixel_mm = camera.film.width_mm / camera.film.width;
    const std::vector<VisibleLight> lights = brightest_in_front(facts);
    const std::vector<AxialTransmittance> transmittances = axial_transmittances(lens);
    // Ghost of one pair for one light, at each of the colours and, last, at the lens's own wavelength.
    struct Discs {
        GhostPair pair;
        std::array<std::optional<GhostDisc>, kColours + 1> by_colour;
    };
    std::vector<Discs> all;
    std::array<double, kColours + 1> veil{};
    for (const GhostPair pair : ghost_pairs(lens)) {
        const auto crossings = crossings_of(lens, pair);
        std::vector<Discs> by_light(lights.size(), Discs{pair, {}});
        for (std::size_t c = 0; c <= kColours; ++c) {
            const GhostBundle bundle(lens, pair, c < kColours ? kColours_nm[c] : lens.wavelength_nm);
            const double transmittance = transmittances[c](crossings);
            const GhostBundle::Cone cone = bundle.cone_to_film_centre();
            const double relative = (cone.sine / sine_of_lens) * (cone.sine / sine_of_lens);
            veil[c] += transmittance * relative * facts.surroundings.mean_within(cone.slope_in_scene);
            for (std::size_t k = 0; k < lights.size(); ++k)
                by_light[k].by_colour[c] = ghost_disc(camera, facts, bundle, lights[k], transmittance, pixel_mm);
        }
        all.insert(all.end(), by_light.begin(), by_light.end());
    }
    double darkest = brightest_value(facts);
    for (const SceneTile& tile : facts.tiles) darkest = std::min(darkest, tile.value);
    GhostChange change;
    for (const double value : veil) {
        const double codes = codes_added(darkest, value);
        change.codes = std::max(change.codes, codes);
        change.colour_codes = std::max(change.colour_codes, std::fabs(codes - codes_added(darkest, veil.back())));
    }
    for (const Discs& discs : all) {
        const std::optional<GhostDisc>& reference = discs.by_colour.back();
        for (std::size_t c = 0; c <= kColours; ++c) {
            const std::optional<GhostDisc>& disc = discs.by_colour[c];
            if (!disc) continue;
            const double codes = codes_added(disc->darkest, disc->value + veil[c]);
            if (codes > change.codes) {
                change.codes = codes;
                change.brightest = discs.pair;
            }
            change.colour_codes =
                std::max(change.colour_codes,
                         reference ? colour_difference(*disc, veil[c], *reference, veil.back(), pixel_mm) : codes);
        }
    }
    return change;
}

/// Change in codes by diffraction, two pixels from overexposed tiles and point lights, where the picture next to them
/// is darkest. The light that a point spreads falls with the third power of the distance, that of an edge with the
/// first (mean over all directions; docs/diffraction.md).
inline double starburst_codes(const Camera& camera, const SceneFacts& facts) {
    using namespace light_effects_detail;
    const LensSystem& lens = camera.lens;
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    const double spread = kGreen_mm * data.f_number / std::pow(std::numbers::pi, 3);
    const double distance = 2 * camera.film.width_mm / camera.film.width;  // two pixels, mm
    const double radius = 0.5 * data.entrance_pupil_diameter;
    double codes = 0;
    const auto add = [&](PicturePosition position, double value) {
        if (const auto dark = darkest_neighbour(facts, position)) codes = std::max(codes, codes_added(*dark, value));
    };
    for (int row = 0; row < facts.rows; ++row)
        for (int column = 0; column < facts.columns; ++column) {
            const double excess = facts.tiles[static_cast<std::size_t>(row * facts.columns + column)].value - 1;
            if (excess > 0)
                add({(column + 0.5) / facts.columns, (row + 0.5) / facts.rows}, 2 * spread / distance * excess);
        }
    for (const VisibleLight& light : brightest_in_front(facts)) {
        if (!light.is_point()) continue;
        const double f = data.effective_focal_length;
        const double flux = light.illuminance_lux * std::numbers::pi * radius * radius;  // lux mm^2
        add(picture_position(camera, f * light.from.x / light.from.z, f * light.from.y / light.from.z),
            developed_value(camera, flux * spread / (distance * distance * distance)));
    }
    return codes;
}

/// Factor by which a central obstruction increases the blur of coarse detail by diffraction. The loss of contrast is
/// proportional to the perimeter of the aperture over its area, which makes the factor 1 / (1 - the ratio of the
/// radii). 1 without an obstruction.
inline double obstruction_blur_factor(const LensSystem& lens) {
    return 1 / (1 - std::sqrt(1 - unobstructed_share(lens, lens.wavelength_nm)));
}

/// Diameter of the first dark ring of the Airy pattern in the film centre, px. `film_sine`: see LensErrors.
inline double airy_diameter_px(const Camera& camera, double film_sine) {
    return 1.22 * light_effects_detail::kGreen_mm / film_sine * camera.film.width / camera.film.width_mm;
}

}  // namespace REALCAM_NAMESPACE
