#include "noise_goal.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace realcam {

void validate(const NoiseGoal& goal) {
    constexpr double kLeast = 1e-9;  // below the rounding of a float; squares of less vanish in double
    if (!(goal.noise >= kLeast) || !std::isfinite(goal.noise))
        throw InputError(goal.unit == NoiseUnit::codes ? "noise_codes must be a number from 1e-9 on: 8-bit codes"
                                                       : "noise must be a number from 1e-9 on: a share of the light");
    if (goal.most_samples < 2 || goal.most_samples > (1 << 24))
        throw InputError("max_spp must lie between 2 and 16777216");
    if (!(goal.seconds > 0)) throw InputError("seconds must be above 0");
}

NoiseGoal goal_of(const NoiseRequest& request) {
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

void look_for_lamps(ReachedNoise& reached, double share, std::int64_t samples) {
    constexpr double kSurelyMet = 5;  // times on average: by Poisson's law, 0.7% of such lamps are missed
    if (!(share * static_cast<double>(samples) < kSurelyMet)) return;
    reached.is_reached = false;
    reached.missed_share = share;
    reached.samples_wanted = std::max(reached.samples_wanted, std::ceil(kSurelyMet / share));
}

std::string shortfall_of(const ReachedNoise& reached, const NoiseGoal& goal) {
    if (reached.is_reached) return "";
    if (!(reached.noise >= 0)) return "too few samples were taken to know how large the noise is";
    const char* unit = goal.unit == NoiseUnit::codes ? " codes" : "";
    char text[300];
    if (reached.missed_share < 1) {
        std::snprintf(text, sizeof text,
                      "lamps fill down to 1/%.2g of what a pixel sees, and may be missing from the picture, because "
                      "light is not traced from them: that takes the camera model full and light_tracing on; without, "
                      "about %.2g samples a pixel are wanted",
                      1 / reached.missed_share, reached.samples_wanted);
        return text;
    }
    std::snprintf(
        text, sizeof text,
        "the noise is %.2g%s where the picture is noisiest, not %.2g%s; about %.2g samples a pixel are wanted "
        "there",
        reached.noise, unit, goal.noise, unit, reached.samples_wanted);
    return text;
}

}  // namespace realcam
