#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "../../error.hpp"
#include "../../platform.hpp"

namespace REALCAM_NAMESPACE {

enum class NoiseUnit {
    relative,  ///< fraction of the mean of a tile of the film, or of a hundredth of white if that is larger
    codes,     ///< 8-bit codes of the picture developed with the linear tone curve
};

/// Noise with which a picture has enough samples: standard deviation of its pixels' means, root mean square over a
/// tile.
struct NoiseGoal {
    double noise = 1;
    NoiseUnit unit = NoiseUnit::codes;
    std::int64_t most_samples = 4096;  ///< limit per pixel, whatever its noise is
    double seconds = std::numeric_limits<double>::infinity();  ///< time limit for sampling

    bool operator==(const NoiseGoal&) const = default;
};

/// Noise settings as given by the user, keyed by their names in Python and in shot files.
struct NoiseRequest {
    std::optional<double> noise, noise_codes, seconds;
    std::optional<std::int64_t> max_spp;

    bool says_nothing() const { return !noise && !noise_codes && !seconds && !max_spp; }
};

/// Result of sampling for a goal. NaN if too few samples were taken to know.
struct ReachedNoise {
    double noise = std::numeric_limits<double>::quiet_NaN();  ///< noise of the noisiest tile, in the goal's unit
    bool is_reached = false;
    double samples_wanted = noise;  ///< samples per pixel that the noisiest tile needs
    /// Smallest fraction of a pixel's footprint that is filled by a lamp which may have been missed; 1 if no lamp was.
    double missed_share = 1;
};

/// Throws InputError if the goal is invalid.
void validate(const NoiseGoal& goal);

/// Throws InputError if both measures are given, or one is invalid.
NoiseGoal goal_of(const NoiseRequest& request);

/// Marks a goal as not reached if lamps in view may have been missed by so small a number of samples: noise that no
/// sample shows cannot be measured. `share`: least_lamp_share; `samples`: of the pixel that has fewest.
void look_for_lamps(ReachedNoise& reached, double share, std::int64_t samples);

/// Sentence on a goal that was not reached; empty if it was.
std::string shortfall_of(const ReachedNoise& reached, const NoiseGoal& goal);

}  // namespace REALCAM_NAMESPACE
