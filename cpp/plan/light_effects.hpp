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

// Changes in codes of the developed picture by ghosts, coatings and diffraction, from closed forms.

namespace light_effects_detail {

inline constexpr double kGreen_mm = 550e-6;

/// Sensor value of an irradiance on the film, lux.
inline double value_of(const Camera& camera, double lux) {
    return sensor_value(lux * camera.exposure_time_s, camera.iso);
}

inline double codes_between(double dark, double added) {
    return code_of(dark + added) - code_of(dark);
}

/// Point of the picture in fractions of its width and height, as imaged by a lens without aberrations.
struct PicturePosition {
    double across, down;
};

inline PicturePosition picture_position(const Camera& camera, double film_x, double film_y) {
    const Film& film = camera.film;
    const Vec2<double> pixel = film.pixel_of({-film_x, -film_y});
    return {pixel.x / film.width, pixel.y / film.height};
}

/// Value of the darkest tile around a point, within these radii; std::nullopt if no tile is.
inline std::optional<double> darkest_within(const SceneFacts& facts, PicturePosition position, double radius_across,
                                            double radius_down) {
    const auto range = [](double middle, double radius, int count) {
        const auto bounded = [&](double share) {
            return static_cast<int>(std::clamp(std::floor(share * count), -1.0, static_cast<double>(count)));
        };
        return std::pair(std::max(0, bounded(middle - radius)), std::min(count - 1, bounded(middle + radius)));
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

/// Value of the darkest tile next to a point of the picture.
inline std::optional<double> darkest_beside(const SceneFacts& facts, PicturePosition position) {
    return darkest_within(facts, position, 1.0 / facts.columns, 1.0 / facts.rows);
}

/// The brightest lights in front of the camera, enough to include the one whose effects are the most visible.
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

/// First-order properties of the light that reaches the film by reflection at a pair of surfaces.
class GhostBundle {
public:
    GhostBundle(const LensSystem& lens, GhostPair pair, double wavelength_nm)
        : lens_(lens),
          path_(ghost_path(lens, wavelength_nm, pair)),
          of_height_(on_film(path_.of_height)),
          of_slope_(on_film(path_.of_slope)) {}

    /// Spot of a parallel bundle: its centre and its radius on the film, mm, and its radius in front of the lens, mm.
    struct Spot {
        double middle, radius, radius_in_front;
    };

    /// Returns std::nullopt if the rims block the whole bundle.
    std::optional<Spot> spot_of(double slope) const {
        double low = -kInfinity, high = kInfinity;
        for (const GhostPath::Meeting& meeting : path_.meetings) {
            const double middle = -meeting.of_slope * slope / meeting.of_height;
            const double radius = std::fabs(rim(meeting.surface) / meeting.of_height);
            low = std::max(low, middle - radius);
            high = std::min(high, middle + radius);
        }
        if (!(high > low)) return {};
        const double radius = (high - low) / 2;
        return Spot{of_height_ * (low + high) / 2 + of_slope_ * slope, std::fabs(of_height_) * radius, radius};
    }

    /// Light that converges on the film centre: the sine of its half angle, and the slope in the scene of its outermost
    /// ray, both limited by the narrowest rim.
    struct View {
        double sine, slope_in_scene;
    };

    View view_from_the_middle() const {
        // A ray to the film centre has height and slope in front of the lens in the ratio of these two.
        const double height = of_slope_, slope = -of_height_;
        double most = kInfinity;
        for (const GhostPath::Meeting& meeting : path_.meetings)
            most =
                std::min(most, rim(meeting.surface) / std::fabs(meeting.of_height * height + meeting.of_slope * slope));
        const double tangent = most * std::fabs(path_.of_height.slope * height + path_.of_slope.slope * slope);
        return {tangent / hypotenuse(tangent, 1.0), most * std::fabs(slope)};
    }

private:
    double on_film(const ParaxialRay& ray) const { return ray.height + lens_.film_distance * ray.slope; }
    double rim(int surface) const {
        const double clear = lens_.surfaces[static_cast<std::size_t>(surface)].clear_semi_diameter;
        return surface == lens_.stop_index() ? std::min(clear, lens_.stop_semi_diameter) : clear;
    }

    const LensSystem& lens_;
    GhostPath path_;
    double of_height_, of_slope_;  ///< film height per unit of height and of slope in front of the lens
};

/// Centres of the red, green and blue bands.
inline constexpr double kColours_nm[] = {610, 540, 460};
inline constexpr std::size_t kColours = std::size(kColours_nm);

/// Axial transmittances at each of the colours and, last, at the lens's own wavelength, which stands for all colours
/// without dispersion.
inline std::vector<AxialShares> shares_of(const LensSystem& lens) {
    std::vector<AxialShares> shares;
    for (const double wavelength_nm : kColours_nm) shares.emplace_back(lens, wavelength_nm);
    shares.emplace_back(lens, lens.wavelength_nm);
    return shares;
}

}  // namespace light_effects_detail

/// Change of the picture by an effect of the surfaces.
struct LightChange {
    double codes = 0;  ///< in the colour that shows it most
    double colour_codes = 0;  ///< largest difference of a colour from the result with one wavelength for all colours
};

/// Light lost at the surfaces, where the picture is brightest without being clipped.
inline LightChange coating_codes(const Camera& camera, const SceneFacts& facts) {
    using namespace light_effects_detail;
    const double value = std::min(brightest(facts), 1.0);
    const auto crossings = crossings_of(camera.lens);
    const std::vector<AxialShares> shares = shares_of(camera.lens);
    const auto codes_of = [&](const AxialShares& share) { return code_of(value) - code_of(value * share(crossings)); };
    const double of_one = codes_of(shares.back());
    LightChange change;
    for (const AxialShares& share : shares) {
        change.codes = std::max(change.codes, codes_of(share));
        change.colour_codes = std::max(change.colour_codes, std::fabs(codes_of(share) - of_one));
    }
    return change;
}

/// Change by ghosts, with the pair of surfaces of the most visible one.
struct GhostChange : LightChange {
    GhostPair brightest{-1, -1};  ///< -1: the veil of all ghosts is the most visible
};

namespace light_effects_detail {

/// Disc that one ghost makes of a lamp on the film, in one colour.
struct GhostDisc {
    double middle, radius;  ///< mm; along the direction to the lamp, from the film centre
    double value;  ///< developed value that it adds
    double darkest;  ///< lowest value of the picture without it, within the disc
};

/// `share`: fraction of the light that the ghost path transmits; `pixel`: pixel size, mm. Returns std::nullopt if the
/// rims block the ghost, or it lies outside the frame.
inline std::optional<GhostDisc> ghost_disc(const Camera& camera, const SceneFacts& facts, const GhostBundle& bundle,
                                           const SeenLight& light, double share, double pixel) {
    const double across = light.from.x / -light.from.z, down = light.from.y / -light.from.z;
    // The position of a ghost is proportional to the slope near the axis; on the axis a small slope avoids 0 / 0.
    const double slope = std::max(hypotenuse(across, down), 1e-6);
    const std::optional<GhostBundle::Spot> spot = bundle.spot_of(slope);
    if (!spot) return {};
    const double chief = spot->middle / slope;
    const double image = light.solid_angle_sr * chief * chief;
    const double radius =
        std::sqrt(std::max(spot->radius * spot->radius, pixel * pixel / 4) + image / std::numbers::pi);
    const PicturePosition position = picture_position(camera, -chief * across, -chief * down);
    const auto dark = darkest_within(facts, position, radius / camera.film.width_mm, radius / camera.film.height_mm);
    if (!dark) return {};
    const double gathered = spot->radius_in_front / radius;
    const double lux = light.illuminance_lux * -light.from.z * gathered * gathered;
    return GhostDisc{spot->middle, radius, value_of(camera, share * lux), *dark};
}

/// Difference in codes between a disc in one colour and that at the lens's own wavelength: by its light, and in the
/// crescent that only one of the two covers. The crescent may be narrower than a pixel.
inline double colour_between(const GhostDisc& disc, double veil, const GhostDisc& of_one, double veil_of_one,
                             double pixel) {
    const double light = std::fabs(codes_between(disc.darkest, disc.value + veil) -
                                   codes_between(disc.darkest, of_one.value + veil_of_one));
    const double crescent = std::fabs(disc.middle - of_one.middle) + std::fabs(disc.radius - of_one.radius);
    return std::max(light, codes_between(disc.darkest, std::min(crescent / pixel, 1.0) * of_one.value));
}

}  // namespace light_effects_detail

/// Changes by ghosts, by first order, in the colour that shows them most. The light of a lamp fills a disc and is the
/// most visible where the picture is darkest within it. The veil of all ghosts of the scene is the most visible where
/// the picture is darkest. Light of radiance L that converges on the film with the sine s has the irradiance pi L s^2.
inline GhostChange ghost_codes(const Camera& camera, const SceneFacts& facts) {
    using namespace light_effects_detail;
    const LensSystem& lens = camera.lens;
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    const double f = std::fabs(data.effective_focal_length);
    const double sine_of_lens = std::min(0.5 * data.entrance_pupil_diameter / f, 1.0);
    const double pixel = camera.film.width_mm / camera.film.width;
    const std::vector<SeenLight> lights = brightest_in_front(facts);
    const std::vector<AxialShares> shares = shares_of(lens);
    struct Discs {
        GhostPair pair;
        std::array<std::optional<GhostDisc>, kColours + 1> of_colours;
    };
    std::vector<Discs> all;
    std::array<double, kColours + 1> veil{};
    for (const GhostPair pair : ghost_pairs(lens)) {
        const auto crossings = crossings_of(lens, pair);
        std::vector<Discs> of_lights(lights.size(), Discs{pair, {}});
        for (std::size_t c = 0; c <= kColours; ++c) {
            const GhostBundle bundle(lens, pair, c < kColours ? kColours_nm[c] : lens.wavelength_nm);
            const double share = shares[c](crossings);
            const GhostBundle::View view = bundle.view_from_the_middle();
            const double relative = (view.sine / sine_of_lens) * (view.sine / sine_of_lens);
            veil[c] += share * relative * facts.surroundings.mean_within(view.slope_in_scene);
            for (std::size_t k = 0; k < lights.size(); ++k)
                of_lights[k].of_colours[c] = ghost_disc(camera, facts, bundle, lights[k], share, pixel);
        }
        all.insert(all.end(), of_lights.begin(), of_lights.end());
    }
    double darkest = brightest(facts);
    for (const SeenTile& tile : facts.tiles) darkest = std::min(darkest, tile.value);
    GhostChange most;
    for (const double of_colour : veil) {
        const double codes = codes_between(darkest, of_colour);
        most.codes = std::max(most.codes, codes);
        most.colour_codes = std::max(most.colour_codes, std::fabs(codes - codes_between(darkest, veil.back())));
    }
    for (const Discs& discs : all) {
        const std::optional<GhostDisc>& of_one = discs.of_colours.back();
        for (std::size_t c = 0; c <= kColours; ++c) {
            const std::optional<GhostDisc>& disc = discs.of_colours[c];
            if (!disc) continue;
            const double codes = codes_between(disc->darkest, disc->value + veil[c]);
            if (codes > most.codes) {
                most.codes = codes;
                most.brightest = discs.pair;
            }
            most.colour_codes = std::max(most.colour_codes,
                                         of_one ? colour_between(*disc, veil[c], *of_one, veil.back(), pixel) : codes);
        }
    }
    return most;
}

/// Diffraction two pixels from bright things, where the picture next to them is darkest: the spread of a point falls
/// with the third power of the distance, that of an edge with the first (mean over all directions;
/// docs/diffraction.md).
inline double starburst_codes(const Camera& camera, const SceneFacts& facts) {
    using namespace light_effects_detail;
    const LensSystem& lens = camera.lens;
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    const double spread = kGreen_mm * data.f_number / std::pow(std::numbers::pi, 3);
    const double away = 2 * camera.film.width_mm / camera.film.width;
    const double radius = 0.5 * data.entrance_pupil_diameter;
    double codes = 0;
    const auto add = [&](PicturePosition position, double value) {
        if (const auto dark = darkest_beside(facts, position)) codes = std::max(codes, codes_between(*dark, value));
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
        add(picture_position(camera, f * light.from.x / light.from.z, f * light.from.y / light.from.z),
            value_of(camera, flux * spread / (away * away * away)));
    }
    return codes;
}

/// Factor by which a central obstruction increases the blur of coarse detail by diffraction. The loss of contrast is
/// proportional to the perimeter of the aperture over its area, which makes the factor 1 / (1 - the ratio of the
/// radii).
inline double edge_of_obstruction(const LensSystem& lens) {
    return 1 / (1 - std::sqrt(1 - unobstructed_share(lens, lens.wavelength_nm)));
}

/// Diameter of the first dark ring of the Airy pattern, in the film centre, px. `film_sine`: see LensErrors.
inline double airy_diameter_px(const Camera& camera, double film_sine) {
    return 1.22 * light_effects_detail::kGreen_mm / film_sine * camera.film.width / camera.film.width_mm;
}

}  // namespace REALCAM_NAMESPACE
