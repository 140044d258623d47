#pragma once
#include <cmath>
#include <cstdint>
#include <cstdio>
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
};

/// Throws InputError for what is no goal.
inline void validate(const NoiseGoal& goal) {
    if (!(goal.noise > 0) || !std::isfinite(goal.noise))
        throw InputError("noise must be above 0: a share of the light, or 8-bit codes");
    if (goal.most_samples < 2 || goal.most_samples > (1 << 24))
        throw InputError("max_spp must lie between 2 and 16777216");
    if (!(goal.seconds > 0)) throw InputError("seconds must be above 0");
}

/// Throws InputError where both measures are given, or one is no goal.
inline NoiseGoal goal_of(const NoiseRequest& request) {
    if (request.noise && request.noise_codes)
        throw InputError("noise (a share of the light) and noise_codes (8-bit codes) exclude each other");
    NoiseGoal goal;
    if (request.noise) goal.unit = NoiseUnit::relative;
    goal.noise = request.noise.value_or(request.noise_codes.value_or(goal.noise));
    goal.seconds = request.seconds.value_or(goal.seconds);
    goal.most_samples = request.max_spp.value_or(goal.most_samples);
    validate(goal);
    return goal;
}

/// A sentence where a goal was not reached; else nothing.
inline std::string shortfall_of(const ReachedNoise& reached, const NoiseGoal& goal) {
    if (reached.is_reached) return "";
    if (!(reached.noise >= 0)) return "too few samples were taken to know how large the noise is";
    const char* unit = goal.unit == NoiseUnit::codes ? " codes" : "";
    char text[200];
    std::snprintf(
        text, sizeof text,
        "the noise is %.2g%s where the picture is noisiest, not %.2g%s; about %.2g samples a pixel are wanted "
        "there",
        reached.noise, unit, goal.noise, unit, reached.samples_wanted);
    return text;
}

}  // namespace REALCAM_NAMESPACE
