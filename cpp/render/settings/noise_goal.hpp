#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "../../error.hpp"
#include "../../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Unit of the noise.
enum class NoiseUnit {
    relative,  ///< fraction of the mean exposure of a tile of the film, or of a hundredth of white if that is larger
    codes,     ///< 8-bit codes of the picture developed with the linear tone curve
};

/// Noise at which sampling ends: the standard deviation of the pixels' means, as root mean square over a tile of the
/// film (AdaptiveSampling).
struct NoiseGoal {
    double noise = 1;
    NoiseUnit unit = NoiseUnit::codes;
    std::int64_t max_samples = 4096;  ///< limit per pixel, whatever its noise is
    double seconds = std::numeric_limits<double>::infinity();  ///< time limit for sampling

    bool operator==(const NoiseGoal&) const = default;
};

/// Noise settings as given by the user, keyed by their names in Python and in shot files.
struct NoiseRequest {
    std::optional<double> noise;        ///< NoiseGoal::noise in NoiseUnit::relative
    std::optional<double> noise_codes;  ///< NoiseGoal::noise in NoiseUnit::codes
    std::optional<double> seconds;      ///< NoiseGoal::seconds
    std::optional<std::int64_t> max_spp;  ///< NoiseGoal::max_samples

    /// True if no value is given.
    bool says_nothing() const { return !noise && !noise_codes && !seconds && !max_spp; }
};

/// Result of sampling for a goal. Numbers are NaN if too few samples were taken to measure the noise.
struct ReachedNoise {
    double noise = std::numeric_limits<double>::quiet_NaN();  ///< noise of the noisiest tile, in the goal's unit
    bool is_reached = false;
    double samples_required = noise;  ///< samples per pixel that the noisiest tile needs
    /// If lamps may have been missed by all samples: smallest fraction of a pixel's footprint that such a lamp fills;
    /// otherwise 1.
    double missed_fraction = 1;
};

/// Throws InputError if the goal is invalid.
void validate(const NoiseGoal& goal);

/// Returns the goal that a user requests, with defaults for missing values. Throws InputError if both noise and
/// noise_codes are given, or a value is invalid.
NoiseGoal goal_of(const NoiseRequest& request);

/// Marks a goal as not reached if all samples may have missed a lamp in view: the noise due to a lamp that no sample
/// hits cannot be measured. `share`: see least_lamp_share; `samples`: smallest number of samples of a pixel.
void check_for_missed_lamps(ReachedNoise& reached, double share, std::int64_t samples);

/// Returns a sentence that says how far a goal was missed; empty if it was reached.
std::string shortfall_message(const ReachedNoise& reached, const NoiseGoal& goal);

}  // namespace REALCAM_NAMESPACE
