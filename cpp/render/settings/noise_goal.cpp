#include "noise_goal.hpp"

#include <algorithm>
#include <cmath>

#include "../../number_text.hpp"

namespace realcam {

void validate(const NoiseGoal& goal) {
    constexpr double kMinNoise = 1e-9;  // below the rounding of a float; the square of a smaller one vanishes in sums
    if (!(goal.noise >= kMinNoise) || !std::isfinite(goal.noise))
        throw InputError(goal.unit == NoiseUnit::codes ? "noise_codes must be at least 1e-9 (8-bit codes)"
                                                       : "noise must be at least 1e-9 (a fraction of the light)");
    if (goal.max_samples < 2 || goal.max_samples > (1 << 24))
        throw InputError("max_spp must lie between 2 and 16777216");
    if (!(goal.seconds > 0)) throw InputError("seconds must be above 0");
}

NoiseGoal goal_of(const NoiseRequest& request) {
    if (request.noise && request.noise_codes)
        throw InputError("noise (a fraction of the light) and noise_codes (8-bit codes) exclude each other");
    NoiseGoal goal;
    if (request.noise) goal.unit = NoiseUnit::relative;
    goal.noise = request.noise.value_or(request.noise_codes.value_or(goal.noise));
    goal.seconds = request.seconds.value_or(goal.seconds);
    goal.max_samples = request.max_spp.value_or(goal.max_samples);
    validate(goal);
    return goal;
}

void check_for_missed_lamps(ReachedNoise& reached, double share, std::int64_t samples) {
    constexpr double kExpectedHits =
        5;  // by the Poisson distribution, 0.7% of lamps with so many expected hits are missed
    if (!(share * static_cast<double>(samples) < kExpectedHits)) return;
    reached.is_reached = false;
    reached.missed_fraction = share;
    reached.samples_required = std::max(reached.samples_required, std::ceil(kExpectedHits / share));
}

std::string shortfall_message(const ReachedNoise& reached, const NoiseGoal& goal) {
    if (reached.is_reached) return "";
    if (!(reached.noise >= 0))
        return "too few samples were taken to measure the noise; more time or samples are needed";
    const std::string required = counted(rounded(reached.samples_required, 2), "sample");
    if (reached.missed_fraction < 1)
        return "lamps that fill only 1/" + number_text(1 / reached.missed_fraction, 2) +
               " of a pixel's field of view may be missing from the picture, because light is not traced from them: "
               "use the camera model full with light_tracing, or about " +
               required + " per pixel";
    const auto noise = [&](double value) {
        return goal.unit == NoiseUnit::codes ? counted(value, "code", 2) : number_text(value, 2);
    };
    return "the noise is " + noise(reached.noise) + " where the picture is noisiest, not " + noise(goal.noise) +
           "; a pixel there needs about " + required;
}

}  // namespace realcam
