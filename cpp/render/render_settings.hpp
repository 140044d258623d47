#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "../camera/camera.hpp"
#include "effects.hpp"
#include "layers.hpp"
#include "noise_goal.hpp"
#include "path_settings.hpp"

namespace REALCAM_NAMESPACE {

inline constexpr int kMaxThreads = 4096;  ///< more than machines have cores; TBB falls over what is far beyond

struct RenderSettings {
    int spp = 64;  ///< samples per pixel
    std::uint32_t seed = 0;
    int max_bounces = 0;  ///< 0: direct light only
    int threads = 0;      ///< of the CPU; 0: all
    LightTransport transport = LightTransport::paths;
    float clamp = 0;  ///< see PathSettings
    LayerSet layers = {};
    EffectChoice effects = {};
    std::optional<Illuminant> illuminant = {};  ///< of dispersion and diffraction; none: D65, the white of RGB
    std::optional<NoiseGoal> noise = {};  ///< instead of spp
    PupilSampling pupil_sampling = PupilSampling::outline;  ///< of a full lens

    /// The light of a picture whose samples have wavelengths; nothing of others.
    std::optional<Illuminant> spectral_light() const {
        return effects.have_wavelengths() ? std::optional(illuminant.value_or(Illuminant())) : std::nullopt;
    }
    LensEffects lens_effects() const {
        return {spectral_light(), effects.dispersion, effects.diffraction,
                effects.coatings, ghost_choice(),     pupil_sampling};
    }
    std::optional<GhostChoice> ghost_choice() const {
        if (!effects.have_ghosts()) return std::nullopt;
        return GhostChoice{effects.ghosts, effects.film_reflection ? effects.film_reflectance : 0, effects.ghost_share};
    }
    PathSettings path() const { return {max_bounces, transport, clamp}; }
};

/// Throws InputError where no picture has so many samples per pixel.
inline void validate_spp(int spp) {
    if (spp < 1 || spp > (1 << 24)) throw InputError("spp must lie between 1 and 16777216");
}

/// Throws InputError where the settings make no sense.
inline void validate(const RenderSettings& settings) {
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

/// Throws InputError where the camera cannot have an effect of the settings.
inline void validate_effects(const RenderSettings& settings, const Camera& camera) {
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

}  // namespace REALCAM_NAMESPACE
