#include "render_settings.hpp"

#include <cmath>

#include "../../camera/effects/effect_tables.hpp"
#include "../../optics/pupil/pupil_grid.hpp"
#include "effect_names.hpp"

namespace realcam {

LensEffects RenderSettings::lens_effects() const {
    return {effects, spectral_light(), lens_filter, ghost_choice(), pupil_sampling};
}

std::optional<GhostChoice> RenderSettings::ghost_choice() const {
    if (!effects.have_ghosts()) return std::nullopt;
    return GhostChoice{effects.ghosts, effects.film_reflection ? effects.film_reflectance : 0, effects.ghost_share};
}

std::string spectrum_error(const RenderSettings& settings) {
    const EffectChoice& effects = settings.effects;
    if (effects.have_wavelengths() || effects.is_automatic) return "";
    const std::string names = effects_that(&EffectInfo::has_wavelengths);
    if (settings.illuminant) return "illuminant belongs to the effects " + names + ", which are not switched on";
    if (settings.lens_filter && !settings.lens_filter->is_neutral())
        return "lens_filter: a coloured filter needs one of the effects " + names + ", which are not switched on";
    return "";
}

void validate(const RenderSettings& settings) {
    validate_spp(settings.spp);
    if (settings.noise) validate(*settings.noise);
    if (settings.max_bounces && (*settings.max_bounces < 0 || *settings.max_bounces > kMostBounces))
        throw InputError("max_bounces must be \"auto\", or lie between 0 and 64");
    if (!(settings.clamp >= 0)) throw InputError("clamp must be 0 (none) or a radiance in cd/m^2");
    if (settings.threads < 0 || settings.threads > kMaxThreads)
        throw InputError("threads must be 0 (all) or a number up to " + std::to_string(kMaxThreads));
    if (const std::string why = spectrum_error(settings); !why.empty()) throw InputError(why);
    if (settings.layers.has_any(kHalfLayers) && settings.layers.has(Layer::variance))
        throw InputError("layers: the variance and the halves of dual pixels cannot be had of one picture");
    if (settings.layers.has_any(kHalfLayers) && settings.light_tracing == LightTracing::alone)
        throw InputError("layers: light that is traced from lamps alone has no halves of dual pixels");
    for (const double threshold : {settings.thresholds.pixels, settings.thresholds.codes})
        if (!(threshold > 0) || !std::isfinite(threshold))
            throw InputError("thresholds of a plan must be above 0: pixels and 8-bit codes");
}

void validate_effects(const RenderSettings& settings, const Camera& camera) {
    if (settings.effects.is_automatic)
        throw InputError("effects: \"auto\" is for pictures that are planned first; specify effects by their names");
    const EffectChoice& effects = settings.effects;
    if (settings.pupil_sampling != PupilSampling::outline && camera.model != CameraModel::full_lens)
        throw InputError("pupil_sampling: the camera's model must be full");
    if (settings.pupil_sampling == PupilSampling::pixel && static_cast<const Effects&>(effects) != kNoEffects)
        throw InputError("pupil_sampling: pixels learn where light passes only without " +
                         effects_that(&EffectInfo::is_compiled));
    if (settings.layers.has_any(kHalfLayers) && camera.model == CameraModel::pinhole)
        throw InputError("layers: the pupil of a pinhole has no halves for dual pixels; choose another model");
    if (settings.layers.has_any(kHalfLayers) && settings.pupil_sampling == PupilSampling::pixel)
        throw InputError("pupil_sampling: pixels that learn where light passes have no halves of dual pixels");
    if (const EffectInfo* effect = first_that(effects, &EffectInfo::needs_round_lens))
        require_radial_pupil(camera.lens, std::string(effect->name));
    if (camera.model == CameraModel::full_lens) return;
    if (const EffectInfo* effect = first_that(effects, &EffectInfo::needs_full_lens))
        throw InputError(std::string(effect->name) + ": the camera's model must be full");
}

}  // namespace realcam
