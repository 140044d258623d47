#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "../camera/camera.hpp"
#include "../camera/effects.hpp"
#include "../camera/ghost_choice.hpp"
#include "../camera/illuminant.hpp"
#include "../camera/pupil_sampling.hpp"
#include "layers.hpp"
#include "noise_goal.hpp"
#include "path_settings.hpp"
#include "plan_thresholds.hpp"

namespace REALCAM_NAMESPACE {

struct LensEffects;

inline constexpr int kMaxThreads = 4096;  ///< more than machines have cores; TBB falls over what is far beyond

inline constexpr EffectChoice kAutomaticEffects = [] {
    EffectChoice effects;
    effects.is_automatic = true;
    return effects;
}();

inline constexpr int kMostBounces = 64;  ///< mirrors that reflect 95% of the light leave 4% of it

/// How a picture is taken: the same value for the command line, shot files, Python, and all kinds of sessions.
struct RenderSettings {
    int spp = 64;  ///< samples per pixel
    std::uint32_t seed = 0;
    std::optional<int> max_bounces = {};  ///< 0: direct light only; none: the planner decides
    int threads = 0;      ///< of the CPU; 0: all
    LightTransport transport = LightTransport::paths;
    double clamp = 0;  ///< see PathSettings
    LayerSet layers = {};
    EffectChoice effects = kAutomaticEffects;
    PlanThresholds thresholds = {};  ///< for effects that are automatic
    std::optional<Illuminant> illuminant = {};  ///< of effects with wavelengths; none: D65, the white of RGB
    std::optional<NoiseGoal> noise = {};  ///< instead of spp
    PupilSampling pupil_sampling = PupilSampling::outline;  ///< of a full lens
    LightTracing light_tracing = LightTracing::weighted;    ///< the same

    bool operator==(const RenderSettings&) const = default;

    /// The light of a picture whose samples have wavelengths; nothing of others.
    std::optional<Illuminant> spectral_light() const {
        return effects.have_wavelengths() ? std::optional(illuminant.value_or(Illuminant())) : std::nullopt;
    }
    LensEffects lens_effects() const;
    std::optional<GhostChoice> ghost_choice() const;
    /// Light that is traced from lamps has no halves of the pupil.
    LightTracing lights_traced() const { return layers.has_any(kHalfLayers) ? LightTracing::off : light_tracing; }
    /// Whether effects or bounces are left to the planner.
    bool needs_plan() const { return effects.is_automatic || !max_bounces; }
    /// Undecided bounces are kMostBounces.
    PathSettings path() const { return {max_bounces.value_or(kMostBounces), transport, static_cast<float>(clamp)}; }
};

/// Throws InputError where no picture has so many samples per pixel.
inline void validate_spp(int spp) {
    if (spp < 1 || spp > (1 << 24)) throw InputError("spp must lie between 1 and 16777216");
}

/// Why an illuminant does not go with the effects; empty: it does.
std::string illuminant_error(const RenderSettings& settings);

/// Throws InputError where the settings make no sense.
void validate(const RenderSettings& settings);

/// Throws InputError where the camera cannot have an effect of the settings.
void validate_effects(const RenderSettings& settings, const Camera& camera);

}  // namespace REALCAM_NAMESPACE
