#include "noise_goal.hpp"

#include <algorithm>
#include <cmath>

#include "../../number_text.hpp"

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
    if (!(reached.noise >= 0))
        return "too few samples were taken to know how large the noise is; more time or samples are needed";
    const std::string wanted = counted(rounded(reached.samples_wanted, 2), "sample");
    if (reached.missed_share < 1)
        return "lamps fill down to 1/" + number_text(1 / reached.missed_share, 2) +
               " of what a pixel sees, and may be missing from the picture, because light is not traced from them: "
               "that takes the camera model full and light_tracing on; without, a pixel needs about " +
               wanted;
    const auto noise = [&](double value) {
        return goal.unit == NoiseUnit::codes ? counted(value, "code", 2) : number_text(value, 2);
    };
    return "the noise is " + noise(reached.noise) + " where the picture is noisiest, not " + noise(goal.noise) +
           "; a pixel there needs about " + wanted;
}

}  // namespace realcam
