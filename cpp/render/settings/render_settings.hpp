#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "../../camera/effects/dispersion/illuminant.hpp"
#include "../../camera/effects/effects.hpp"
#include "../../camera/effects/filter/lens_filter.hpp"
#include "../../camera/effects/ghosts/ghost_view.hpp"
#include "../../camera/film/camera.hpp"
#include "../../camera/models/pupil_sampling.hpp"
#include "../../platform.hpp"
#include "../layers/layers.hpp"
#include "../path/path_settings.hpp"
#include "noise_goal.hpp"

namespace REALCAM_NAMESPACE {

/// Sizes from which on the planner simulates an effect (cpp/plan). An effect is simulated if it exceeds one of them.
struct PlanThresholds {
    double pixels = 0.5;  ///< displacement or blur
    double codes = 1;     ///< change of an 8-bit code of the developed picture

    bool operator==(const PlanThresholds&) const = default;
};

/// Names that quality_named knows, for messages.
inline constexpr const char* kQualityNames = "draft, photo or reference";

/// Returns the thresholds of a named quality; std::nullopt if the name is unknown.
inline std::optional<PlanThresholds> quality_named(const std::string& name) {
    if (name == "draft") return PlanThresholds{2, 4};
    if (name == "photo") return PlanThresholds{};
    if (name == "reference") return PlanThresholds{0.1, 0.25};
    return std::nullopt;
}

struct LensEffects;

/// Limit on RenderSettings::threads: more than machines have cores; TBB fails far beyond this.
inline constexpr int kMaxThreads = 4096;

/// Effects that the planner chooses.
inline constexpr EffectChoice kAutomaticEffects = [] {
    EffectChoice effects;
    effects.is_automatic = true;
    return effects;
}();

/// Limit on RenderSettings::max_bounces: after 64 mirrors that reflect 95%, 4% of the light is left.
inline constexpr int kMaxBounces = 64;

/// Settings of a picture, common to the command line, shot files, Python, and all kinds of sessions.
struct RenderSettings {
    int spp = 64;  ///< samples per pixel
    std::uint32_t seed = 0;  ///< of the random numbers
    std::optional<int> max_bounces = {};  ///< 0: direct light only; std::nullopt: the planner decides
    int threads = 0;      ///< CPU threads; 0: all
    LightTransport transport = LightTransport::paths;
    double clamp = 0;  ///< see PathSettings
    LayerSet layers = {};  ///< additional outputs
    EffectChoice effects = kAutomaticEffects;  ///< effects that are simulated
    PlanThresholds thresholds = {};  ///< for automatic effects
    std::optional<Illuminant> illuminant = {};  ///< for effects with wavelengths; std::nullopt: D65, the white of RGB
    /// Filter in front of the lens; a coloured one needs effects with wavelengths.
    std::optional<LensFilter> lens_filter = {};
    std::optional<NoiseGoal> noise = {};  ///< goal of adaptive sampling, instead of spp
    PixelFilter filter = PixelFilter::box;  ///< of pixels
    PupilSampling pupil_sampling = PupilSampling::outline;  ///< for a full lens
    LightTracing light_tracing = LightTracing::weighted;  ///< for a full lens

    bool operator==(const RenderSettings&) const = default;

    /// Illuminant of a picture whose samples have wavelengths; std::nullopt if they have none.
    std::optional<Illuminant> spectral_light() const {
        return effects.have_wavelengths() ? std::optional(illuminant.value_or(Illuminant())) : std::nullopt;
    }
    /// Factor of the exposure by the filter. If samples have wavelengths, it applies to each of them instead.
    double filter_transmittance() const {
        return lens_filter && !effects.have_wavelengths() ? lens_filter->luminous_transmittance() : 1;
    }
    /// Prepares the settings for a picture whose samples have no wavelengths: removes the illuminant, and replaces a
    /// coloured filter by the neutral one that is equally bright.
    void remove_spectra() {
        illuminant.reset();
        if (lens_filter) lens_filter = lens_filter->neutral_equivalent();
    }
    /// Settings that a camera's set-up depends on (CameraSetup).
    LensEffects lens_effects() const;
    /// Selection of ghosts; std::nullopt if no ghosts are simulated.
    std::optional<GhostChoice> ghost_choice() const;
    /// `light_tracing`, but off for dual-pixel layers: splatted light is not separated by halves of the pupil.
    LightTracing effective_light_tracing() const {
        return layers.has_any(kHalfLayers) ? LightTracing::off : light_tracing;
    }
    /// True if effects or bounces are left to the planner.
    bool needs_plan() const { return effects.is_automatic || !max_bounces; }
    /// Settings of the path tracer; undecided bounces are set to kMaxBounces.
    PathSettings path() const { return {max_bounces.value_or(kMaxBounces), transport, static_cast<float>(clamp)}; }
};

/// Throws InputError if the number of samples per pixel is out of range.
inline void validate_spp(int spp) {
    if (spp < 1 || spp > (1 << 24)) throw InputError("spp must lie between 1 and 16777216");
}

/// Reason why the illuminant or a coloured filter does not go with the effects; empty if they do.
std::string spectrum_error(const RenderSettings& settings);

/// Throws InputError if settings are invalid or contradict each other.
void validate(const RenderSettings& settings);

/// Throws InputError if the camera does not support the effects, layers or pupil sampling of the settings.
void validate_effects(const RenderSettings& settings, const Camera& camera);

}  // namespace REALCAM_NAMESPACE
