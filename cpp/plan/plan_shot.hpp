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

/// Effects of a picture without a plan: those that the user named.
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

class Planner {
public:
    Planner(const Camera& camera, const LensErrors& errors, const SceneFacts& facts, const RenderSettings& settings)
        : camera_(with_centred_lens(camera)),
          errors_(errors),
          facts_(facts),
          settings_(settings),
          is_round_(is_round_lens(camera.lens)) {}

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

    /// Reason why the lens cannot show the effect; if it can, `doubt`.
    std::string doubt_or_refusal(const EffectInfo& effect, const std::string& doubt) const {
        return effect.needs_round_lens && !is_round_ ? "but only a centred lens of revolution can show it" : doubt;
    }

    /// `reason`: source of the size, in words. `leave`: why only the user may switch the effect on; empty if the
    /// planner may.
    void decide(const char* name, double size, SizeUnit unit, std::string reason, const std::string& leave = "") {
        const EffectInfo& effect = *find_effect(name);
        const std::string doubt = doubt_or_refusal(effect, leave);
        const double threshold = unit == SizeUnit::pixels ? settings_.thresholds.pixels : settings_.thresholds.codes;
        const bool is_named = (settings_.effects.named & bit_of(effect)) != 0;
        const bool is_kept =
            is_named ? settings_.effects.*effect.member : size >= threshold && doubt.empty() && !is_impossible(effect);
        if (!is_named && size >= threshold && !is_kept)
            reason += "; " + (doubt.empty() ? "an ideal lens cannot show it" : doubt);
        plan_.effects.*effect.member = is_kept;
        plan_.decisions.push_back({name, size, unit, threshold, is_kept,
                                   is_named ? DecidedBy::user : DecidedBy::planner, std::nullopt, reason});
    }

    /// Reason to leave effects of coatings to the user: glass of unknown coating is simulated as bare, which few lenses
    /// are. Empty if the coatings of all glass are known.
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
        decide("coatings", light.codes, SizeUnit::codes,
               "the glass takes " + codes(light.codes) + " from what is bright", doubt_of_coatings());
        if (plan_.effects.coatings) coating_colour_codes_ = light.colour_codes;
    }

    void decide_ghosts() {
        const GhostChange light = ghost_codes(camera_, facts_);
        const auto surface = [](int number) { return std::to_string(number + 1); };
        decide("ghosts", light.codes, SizeUnit::codes,
               light.brightest.first < 0
                   ? "the veil of all ghosts brings " + codes(light.codes) + " to what is dark"
                   : "ghosts and their veil bring " + codes(light.codes) + " to what is dark, most by surfaces " +
                         surface(light.brightest.first) + " and " + surface(light.brightest.second),
               doubt_of_coatings());
        if (plan_.effects.ghosts) ghost_colour_codes_ = light.colour_codes;
    }

    void decide_diffraction() {
        const double airy = airy_diameter_px(camera_, errors_.film_sine), star = starburst_codes(camera_, facts_);
        const double more = edge_of_obstruction(camera_.lens), spread = more * airy;
        if (spread / settings_.thresholds.pixels >= star / settings_.thresholds.codes)
            decide("diffraction", spread, SizeUnit::pixels,
                   more == 1 ? "Airy's disc is " + px(airy) + " wide"
                             : "with the edge of what blocks the lens's middle, as much light is spread as by an "
                               "Airy disc of " +
                                   px(spread));
        else
            decide("diffraction", star, SizeUnit::codes,
                   "the stars of lamps bring " + codes(star) + " two pixels beside them");
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
        const double of_glass = std::max(lateral, axial);
        const double of_coatings = plan_.effects.diffraction ? 0.0 : coating_colour_codes_;
        const double of_filter = plan_.effects.diffraction ? 0.0 : filter_colour_codes();
        const double of_light = std::max({of_coatings, ghost_colour_codes_, of_filter});
        if (of_glass / settings_.thresholds.pixels < of_light / settings_.thresholds.codes)
            decide("dispersion", of_light, SizeUnit::codes,
                   (of_filter == of_light               ? "the filter's colour changes white by "
                    : of_coatings > ghost_colour_codes_ ? "what the coatings take has a colour of "
                                                        : "ghosts have a colour of ") +
                       codes(of_light));
        else
            decide("dispersion", of_glass, SizeUnit::pixels,
                   lateral >= axial ? "blue and red light fall " + px(of_glass) + " apart"
                                    : "blue and red light are not blurred alike, by a disc of " + px(of_glass));
    }

    void decide_motion() {
        double most = 0;
        for (const SeenTile& tile : facts_.tiles)
            if (tile.motion_px > most) most = tile.motion_px;  // NaN: the surface leaves the image circle
        if (most == 0) return;
        const double seen = camera_.exposure_time_s, rows = camera_.shutter.readout_time_s;
        const double skew = seen > 0 ? most * rows / seen : 0;
        decide("motion_blur", most, SizeUnit::pixels, "while a pixel is exposed things move by " + px(most));
        decide("rolling_shutter", skew, SizeUnit::pixels, "from the first row to the last things move by " + px(skew));
    }

    void decide_model() {
        const PlanThresholds& thresholds = settings_.thresholds;
        CameraModel model = CameraModel::full_lens;
        if (!may_choose_model_)
            model = camera_.model;
        else if (is_round_ && !any_is(plan_.effects, &EffectInfo::needs_full_lens))
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
            const bool comes_along = is_kept && size < threshold && by == DecidedBy::planner;
            plan_.decisions.push_back({name, size, unit, threshold, is_kept, by, std::nullopt,
                                       reason + (comes_along ? "; it comes along with the camera model" : "")});
        };
        add("defocus", errors_.defocus_px, SizeUnit::pixels, !is_pinhole,
            "discs of confusion are up to " + px(errors_.defocus_px) + " wide");
        add("aberrations", errors_.mapped.blur_px, SizeUnit::pixels, is_full,
            "a thin lens's picture is sharper or softer by a disc of " + px(errors_.mapped.blur_px));
        add("distortion", errors_.thin.moved_px, SizeUnit::pixels, has_map,
            "a thin lens shows things " + px(errors_.thin.moved_px) + " elsewhere");
        add("vignetting", errors_.thin.light_codes, SizeUnit::codes, has_map,
            "a thin lens's picture differs by " + codes(errors_.thin.light_codes) + " towards the corners");
    }

    Camera camera_;
    const LensErrors& errors_;
    const SceneFacts& facts_;
    const RenderSettings& settings_;
    const bool is_round_;
    const bool may_choose_model_ = camera_.model == CameraModel::full_lens;  ///< otherwise the camera's model is used
    Plan plan_;
    double coating_colour_codes_ = 0, ghost_colour_codes_ = 0;  ///< only for effects that are kept
};

}  // namespace plan_shot_detail

/// Plans which effects and which camera model a shot needs. Effects that the settings name stay as specified.
inline Plan plan_shot(const Camera& camera, const LensErrors& errors, const SceneFacts& facts,
                      const RenderSettings& settings) {
    return plan_shot_detail::Planner(camera, errors, facts, settings).plan();
}

}  // namespace REALCAM_NAMESPACE
