#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "../error.hpp"
#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

enum class NoiseUnit {
    relative,  ///< of the mean of a tile of the film, or of a hundredth of white where that is more
    codes,     ///< 8-bit, of the picture developed with the linear tone curve
};

/// When a picture has enough samples: standard deviation of its pixels' means, root mean square over a tile.
struct NoiseGoal {
    double noise = 1;
    NoiseUnit unit = NoiseUnit::codes;
    std::int64_t most_samples = 4096;  ///< of a pixel, whatever its noise is then
    double seconds = std::numeric_limits<double>::infinity();  ///< after which no more samples are taken

    bool operator==(const NoiseGoal&) const = default;
};

/// What a user says of the noise, under the names of Python and of shot files.
struct NoiseRequest {
    std::optional<double> noise, noise_codes, seconds;
    std::optional<std::int64_t> max_spp;

    bool says_nothing() const { return !noise && !noise_codes && !seconds && !max_spp; }
};

/// What has become of a goal. No numbers where too few samples were taken to know.
struct ReachedNoise {
    double noise = std::numeric_limits<double>::quiet_NaN();  ///< of the noisiest tile, in the goal's unit
    bool is_reached = false;
    double samples_wanted = noise;  ///< of a pixel there, for the goal
    /// Of what a pixel's samples see, the part that a lamp fills which may have been missed; 1: there is none.
    double missed_share = 1;
};

/// Throws InputError for what is no goal.
void validate(const NoiseGoal& goal);

/// Throws InputError where both measures are given, or one is no goal.
NoiseGoal goal_of(const NoiseRequest& request);

/// Takes back that a goal is reached where lamps may be in view which so few samples have missed: noise that no sample
/// shows cannot be measured. `share`: least_lamp_share; `samples`: of the pixel that has fewest.
void look_for_lamps(ReachedNoise& reached, double share, std::int64_t samples);

/// A sentence where a goal was not reached; else nothing.
std::string shortfall_of(const ReachedNoise& reached, const NoiseGoal& goal);

}  // namespace REALCAM_NAMESPACE
