#include "render_settings.hpp"

#include <string>

namespace realcam {

LensEffects RenderSettings::lens_effects() const {
    return {spectral_light(), effects.dispersion, effects.diffraction,
            effects.coatings, ghost_choice(),     pupil_sampling};
}

std::optional<GhostChoice> RenderSettings::ghost_choice() const {
    if (!effects.have_ghosts()) return std::nullopt;
    return GhostChoice{effects.ghosts, effects.film_reflection ? effects.film_reflectance : 0, effects.ghost_share};
}

void validate(const RenderSettings& settings) {
    validate_spp(settings.spp);
    if (settings.noise) validate(*settings.noise);
    if (settings.max_bounces < 0 || settings.max_bounces > 64)
        throw InputError("max_bounces must lie between 0 and 64");
    if (!(settings.clamp >= 0)) throw InputError("clamp must be 0 (none) or a radiance in cd/m^2");
    if (settings.threads < 0 || settings.threads > kMaxThreads)
        throw InputError("threads must be 0 (all) or a number up to " + std::to_string(kMaxThreads));
    if (settings.illuminant && !settings.effects.have_wavelengths() && !settings.effects.is_automatic)
        throw InputError("illuminant belongs to the effects dispersion and diffraction, which are not switched on");
}

void validate_effects(const RenderSettings& settings, const Camera& camera) {
    if (settings.effects.is_automatic)
        throw InputError("effects: \"auto\" is for pictures that are planned first; names of effects are wanted");
    const EffectChoice& effects = settings.effects;
    if (settings.pupil_sampling != PupilSampling::outline && camera.model != CameraModel::full_lens)
        throw InputError("pupil_sampling: the camera's model must be full");
    if (settings.pupil_sampling == PupilSampling::pixel && (effects.have_wavelengths() || effects.coatings))
        throw InputError(
            "pupil_sampling: pixels learn where light passes only without dispersion, coatings and "
            "diffraction");
    if (camera.model == CameraModel::full_lens) return;
    if (effects.dispersion || effects.coatings || effects.have_ghosts())
        throw InputError(std::string(effects.dispersion ? "dispersion"
                                     : effects.coatings ? "coatings"
                                     : effects.ghosts   ? "ghosts"
                                                        : "film_reflection") +
                         ": the camera's model must be full");
}

}  // namespace realcam
