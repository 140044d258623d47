#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "../camera/effects/direct_lens_path.hpp"
#include "../camera/effects/dispersion/film_spectrum.hpp"
#include "../optics/coating/coated_surface.hpp"
#include "../render/settings/effect_names.hpp"
#include "../render/settings/render_settings.hpp"
#include "lens_errors.hpp"
#include "light_effects.hpp"
#include "plan.hpp"

namespace REALCAM_NAMESPACE {

/// Effects of a picture that is not planned: those that the user named.
inline EffectChoice without_plan(EffectChoice effects) {
    effects.is_automatic = false;
    effects.named = 0;
    return effects;
}

namespace plan_shot_detail {

/// Formats a size with about two digits.
inline std::string short_size(double size) {
    char text[32];
    std::snprintf(text, sizeof text, size < 0.095 ? "%.2g" : size < 9.95 ? "%.1f" : "%.0f", size);
    return text;
}

/// Decides on the effects and the camera model of a shot; see plan_shot. The references must outlive the object.
class Planner {
public:
    Planner(const Camera& camera, const LensErrors& errors, const SceneFacts& facts, const RenderSettings& settings)
        : camera_(with_centred_lens(camera)),
          errors_(errors),
          facts_(facts),
          settings_(settings),
          is_rotational_(uses_rotational_code(camera.lens)) {}

    Plan plan() {
        plan_.effects = without_plan(settings_.effects);
        decide_coatings();
        decide_ghosts();
        decide_diffraction();
        decide_colour();
        decide_motion();
        decide_model();
        return plan_;
    }

private:
    static Camera with_centred_lens(Camera camera) {
        camera.lens = centred(camera.lens);
        return camera;
    }

    /// True if the effect needs the surfaces of the lens, and the user chose an ideal lens.
    bool is_impossible(const EffectInfo& effect) const { return effect.needs_full_lens && !may_choose_model_; }

    /// Returns why the planner must not switch the effect on: because the lens cannot show it or, if it can, because of
    /// `doubt`, which may be empty.
    std::string objection_to(const EffectInfo& effect, const std::string& doubt) const {
        return effect.needs_rotational_lens && !is_rotational_
                   ? "but only a centred, rotationally symmetric lens can show it"
                   : doubt;
    }

    /// Decides on an effect, by its name in kEffects. `size`: change of the picture if it is left out. `reason`:
    /// sentence that explains the size. `doubt`: why only the user may switch the effect on; empty if the planner may.
    void decide(const char* name, double size, SizeUnit unit, std::string reason, const std::string& doubt = "") {
        const EffectInfo& effect = *find_effect(name);
        const std::string objection = objection_to(effect, doubt);
        const double threshold = unit == SizeUnit::pixels ? settings_.thresholds.pixels : settings_.thresholds.codes;
        const bool is_named = (settings_.effects.named & bit_of(effect)) != 0;
        const bool is_kept = is_named ? settings_.effects.*effect.member
                                      : size >= threshold && objection.empty() && !is_impossible(effect);
        if (!is_named && size >= threshold && !is_kept)
            reason += "; " + (objection.empty() ? "an ideal lens cannot show it" : objection);
        plan_.effects.*effect.member = is_kept;
        plan_.decisions.push_back({name, size, unit, threshold, is_kept,
                                   is_named ? DecidedBy::user : DecidedBy::planner, std::nullopt, reason});
    }

    /// Returns why effects of coatings are left to the user: glass of unknown coating is simulated as bare, which few
    /// lenses are. Empty if the coatings of all glass are known.
    std::string doubt_of_coatings() const {
        const std::vector<Surface>& surfaces = camera_.lens.surfaces;
        const std::vector<int> unknown = surfaces_with_unknown_coating(camera_.lens);
        return std::none_of(
                   unknown.begin(), unknown.end(),
                   [&](int i) { return surfaces[static_cast<std::size_t>(i)].type == SurfaceType::refracting; })
                   ? ""
                   : "left out because the lens file does not say how the glass is coated; name the effect to have "
                     "bare glass";
    }

    static std::string px(double size) { return short_size(size) + " px"; }
    static std::string codes(double size) { return short_size(size) + (size == 1 ? " code" : " codes"); }

    void decide_coatings() {
        const LightChange light = coating_codes(camera_, facts_);
        decide("coatings", light.codes, SizeUnit::codes, "the surfaces darken bright areas by " + codes(light.codes),
               doubt_of_coatings());
        if (plan_.effects.coatings) coating_colour_codes_ = light.colour_codes;
    }

    void decide_ghosts() {
        const GhostChange light = ghost_codes(camera_, facts_);
        const auto surface = [](int number) { return std::to_string(number + 1); };
        decide("ghosts", light.codes, SizeUnit::codes,
               light.brightest.first < 0
                   ? "the veiling glare of all ghosts brightens dark areas by " + codes(light.codes)
                   : "ghosts and their veiling glare brighten dark areas by " + codes(light.codes) +
                         ", most by surfaces " + surface(light.brightest.first) + " and " +
                         surface(light.brightest.second),
               doubt_of_coatings());
        if (plan_.effects.ghosts) ghost_colour_codes_ = light.colour_codes;
    }

    void decide_diffraction() {
        const double airy = airy_diameter_px(camera_, errors_.film_sine), star = starburst_codes(camera_, facts_);
        const double factor = obstruction_blur_factor(camera_.lens), spread = factor * airy;
        if (spread / settings_.thresholds.pixels >= star / settings_.thresholds.codes)
            decide("diffraction", spread, SizeUnit::pixels,
                   factor == 1 ? "the Airy disc is " + px(airy) + " wide"
                               : "with its central obstruction, the lens spreads as much light as an Airy disc of " +
                                     px(spread));
        else
            decide("diffraction", star, SizeUnit::codes,
                   "starbursts of lights brighten the picture by " + codes(star) + " two pixels beside them");
    }

    /// Change of white by the filter in the channel that shows it most, against a neutral filter that is equally
    /// bright.
    double filter_colour_codes() const {
        if (!settings_.lens_filter || settings_.lens_filter->is_neutral()) return 0;
        const FilmSpectrum spectrum(settings_.illuminant.value_or(Illuminant()), settings_.lens_filter);
        const std::array<float, 9> film = spectrum.mean_film();
        double most = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            const auto white = static_cast<double>(film[3 * c] + film[3 * c + 1] + film[3 * c + 2]);
            most = std::max(most, std::fabs(code_of(white) - code_of(settings_.lens_filter->luminous_transmittance())));
        }
        return most;
    }

    /// Decides on the colour of glass, coatings, ghosts and the filter. Coatings and filter are evaluated at one
    /// wavelength unless dispersion or diffraction samples others; ghosts are unless dispersion does.
    void decide_colour() {
        const double lateral = errors_.lateral_colour_px, axial = errors_.axial_colour_px;
        const double glass_px = std::max(lateral, axial);
        const double coatings_codes = plan_.effects.diffraction ? 0.0 : coating_colour_codes_;
        const double filter_codes = plan_.effects.diffraction ? 0.0 : filter_colour_codes();
        const double light_codes = std::max({coatings_codes, ghost_colour_codes_, filter_codes});
        if (glass_px / settings_.thresholds.pixels < light_codes / settings_.thresholds.codes)
            decide("dispersion", light_codes, SizeUnit::codes,
                   (filter_codes == light_codes            ? "the filter's colour changes white by "
                    : coatings_codes > ghost_colour_codes_ ? "the losses at the coatings differ between colours by "
                                                           : "ghosts differ between colours by ") +
                       codes(light_codes));
        else
            decide("dispersion", glass_px, SizeUnit::pixels,
                   lateral >= axial ? "blue and red light land " + px(glass_px) + " apart"
                                    : "blue and red light differ in blur by a disc of " + px(glass_px));
    }

    void decide_motion() {
        double largest = 0;
        for (const SceneTile& tile : facts_.tiles)
            if (tile.motion_px > largest)
                largest = tile.motion_px;  // false if NaN: the surface leaves the image circle
        if (largest == 0) return;
        const double exposure_s = camera_.exposure_time_s, readout_s = camera_.shutter.readout_time_s;
        const double skew = exposure_s > 0 ? largest * readout_s / exposure_s : 0;
        decide("motion_blur", largest, SizeUnit::pixels,
               "during the exposure of a pixel, objects move by up to " + px(largest));
        decide("rolling_shutter", skew, SizeUnit::pixels,
               "from the first row to the last, objects move by up to " + px(skew));
    }

    /// Chooses the cheapest camera model whose differences from the full lens stay below the thresholds, and records a
    /// decision for each property of the lens that a cheaper model lacks.
    void decide_model() {
        const PlanThresholds& thresholds = settings_.thresholds;
        CameraModel model = CameraModel::full_lens;
        if (!may_choose_model_)
            model = camera_.model;
        else if (is_rotational_ && !any_active_has(plan_.effects, &EffectInfo::needs_full_lens))
            model = errors_.pinhole.is_within(thresholds)  ? CameraModel::pinhole
                    : errors_.thin.is_within(thresholds)   ? CameraModel::thin_lens
                    : errors_.mapped.is_within(thresholds) ? CameraModel::mapped_lens
                    : errors_.thick.is_within(thresholds)  ? CameraModel::thick_lens
                                                           : CameraModel::full_lens;
        plan_.model = model;
        const bool is_pinhole = model == CameraModel::pinhole, is_full = model == CameraModel::full_lens;
        const bool has_map = is_full || model == CameraModel::mapped_lens || model == CameraModel::thick_lens;
        const DecidedBy by = may_choose_model_ ? DecidedBy::planner : DecidedBy::user;
        const auto add = [&](const char* name, double size, SizeUnit unit, bool is_kept, const std::string& reason) {
            const double threshold = unit == SizeUnit::pixels ? thresholds.pixels : thresholds.codes;
            const bool is_implied = is_kept && size < threshold && by == DecidedBy::planner;
            plan_.decisions.push_back({name, size, unit, threshold, is_kept, by, std::nullopt,
                                       reason + (is_implied ? "; the camera model includes it" : "")});
        };
        add("defocus", errors_.defocus_px, SizeUnit::pixels, !is_pinhole,
            "circles of confusion are up to " + px(errors_.defocus_px) + " wide");
        add("aberrations", errors_.mapped.blur_px, SizeUnit::pixels, is_full,
            "the blur of a thin lens differs by a disc of " + px(errors_.mapped.blur_px));
        add("distortion", errors_.thin.moved_px, SizeUnit::pixels, has_map,
            "a thin lens displaces the image by up to " + px(errors_.thin.moved_px));
        add("vignetting", errors_.thin.light_codes, SizeUnit::codes, has_map,
            "towards the corners, a thin lens's picture differs in brightness by up to " +
                codes(errors_.thin.light_codes));
    }

    Camera camera_;
    const LensErrors& errors_;
    const SceneFacts& facts_;
    const RenderSettings& settings_;
    const bool is_rotational_;
    const bool may_choose_model_ = camera_.model == CameraModel::full_lens;  ///< otherwise the camera's model is used
    Plan plan_;
    double coating_colour_codes_ = 0, ghost_colour_codes_ = 0;  ///< 0 if the effect is left out
};

}  // namespace plan_shot_detail

/// Plans which effects and which camera model a shot needs. Effects that the settings name stay as specified.
inline Plan plan_shot(const Camera& camera, const LensErrors& errors, const SceneFacts& facts,
                      const RenderSettings& settings) {
    return plan_shot_detail::Planner(camera, errors, facts, settings).plan();
}

}  // namespace REALCAM_NAMESPACE
