#include "render_settings.hpp"

#include <cmath>

#include "../../camera/effects/effect_tables.hpp"
#include "../../optics/pupil/film_symmetry.hpp"
#include "effect_names.hpp"

namespace realcam {

LensEffects RenderSettings::lens_effects() const {
    return {effects, spectral_light(), lens_filter, ghost_choice(), pupil_sampling, filter};
}

std::optional<GhostChoice> RenderSettings::ghost_choice() const {
    if (!effects.have_ghosts()) return std::nullopt;
    return GhostChoice{effects.ghosts, effects.film_reflection ? effects.film_reflectance : 0, effects.ghost_share};
}

std::string spectrum_error(const RenderSettings& settings) {
    const EffectChoice& effects = settings.effects;
    if (effects.have_wavelengths() || effects.is_automatic) return "";
    const std::string one_of =
        " needs one of the effects " + effects_that(&EffectInfo::has_wavelengths) + ", none of which is switched on";
    if (settings.illuminant) return "illuminant" + one_of;
    if (settings.lens_filter && !settings.lens_filter->is_neutral()) return "lens_filter: a coloured filter" + one_of;
    return "";
}

void validate(const RenderSettings& settings) {
    validate_spp(settings.spp);
    if (settings.noise) validate(*settings.noise);
    if (settings.max_bounces && (*settings.max_bounces < 0 || *settings.max_bounces > kMaxBounces))
        throw InputError("max_bounces must be \"auto\", or lie between 0 and " + std::to_string(kMaxBounces));
    if (!(settings.clamp >= 0)) throw InputError("clamp_cd_m2 must be 0 (none) or a positive radiance in cd/m^2");
    if (settings.threads < 0 || settings.threads > kMaxThreads)
        throw InputError("threads must be 0 (all) or a number up to " + std::to_string(kMaxThreads));
    if (const std::string why = spectrum_error(settings); !why.empty()) throw InputError(why);
    if (settings.layers.has_any(kHalfLayers) && settings.layers.has(Layer::variance))
        throw InputError("layers: variance and dual-pixel halves exclude each other");
    if (settings.layers.has_any(kHalfLayers) && settings.light_tracing == LightTracing::alone)
        throw InputError("layers: dual-pixel halves need samples of pixels; light_tracing must not be alone");
    for (const double threshold : {settings.thresholds.pixels, settings.thresholds.codes})
        if (!(threshold > 0) || !std::isfinite(threshold))
            throw InputError("the thresholds of a plan (pixels and 8-bit codes) must be above 0");
}

void validate_effects(const RenderSettings& settings, const Camera& camera) {
    if (settings.effects.is_automatic)
        throw InputError("effects: \"auto\" is for pictures that are planned first; specify effects by their names");
    const EffectChoice& effects = settings.effects;
    if (settings.pupil_sampling != PupilSampling::outline && camera.model != CameraModel::full_lens)
        throw InputError("pupil_sampling: the camera's model must be full");
    if (settings.pupil_sampling == PupilSampling::pixel && static_cast<const Effects&>(effects) != kNoEffects)
        throw InputError("pupil_sampling: pixel excludes the effects " + effects_that(&EffectInfo::is_compiled));
    if (settings.layers.has_any(kHalfLayers) && camera.model == CameraModel::pinhole)
        throw InputError("layers: a pinhole has no dual-pixel halves; choose another camera model");
    if (settings.layers.has_any(kHalfLayers) && settings.pupil_sampling == PupilSampling::pixel)
        throw InputError("pupil_sampling: pixel excludes the layers of dual-pixel halves");
    if (const EffectInfo* effect = first_active_with(effects, &EffectInfo::needs_rotational_lens))
        require_radial_pupil(camera.lens, std::string(effect->name));
    if (camera.model == CameraModel::full_lens) return;
    const EffectInfo* effect = first_active_with(effects, &EffectInfo::needs_full_lens);
    if (!effect && camera.ray_pairs) effect = first_active_with(effects, &EffectInfo::needs_rotational_lens);
    if (effect)
        throw InputError(std::string(effect->name) +
                         (camera.ray_pairs ? ": it needs the surfaces of the lens, of which only rays were measured"
                                           : ": the camera's model must be full"));
}

}  // namespace realcam
