#include "sampling_notice.hpp"

#include <algorithm>
#include <cmath>

#include "values.hpp"

namespace realcam::app {
namespace {

std::string duration_text(double seconds) {
    if (seconds < 100) return number_text(std::max(1.0, std::round(seconds)), 2) + " s";
    if (seconds < 6000) return number_text(seconds / 60, 2) + " minutes";
    return number_text(seconds / 3600, 2) + " hours";
}

/// Shorter durations are not announced.
constexpr double kLong_s = 3;

}  // namespace

std::string SamplingNotice::aim() const {
    const bool is_in_codes = goal_.unit == NoiseUnit::codes;
    std::string text =
        "samples are taken until the noise is " +
        (is_in_codes ? counted(goal_.noise, "code") + " of 255" : number_text(100 * goal_.noise) + "% of the light");
    if (std::isfinite(goal_.seconds)) text += ", for " + number_text(goal_.seconds) + " s at most";
    if (sampling_ == shot::Sampling::unsaid) text += "; --noise-codes, --seconds or --spp say otherwise";
    return text;
}

double SamplingNotice::took(double share) {
    share_ = share;
    elapsed_s_ = std::chrono::duration<double>(Clock::now() - start_).count();
    return std::min(1.0, std::max(share, elapsed_s_ / goal_.seconds));
}

std::string SamplingNotice::expectation() {
    if (has_reported_ || !(share_ > 0) || share_ >= 1) return "";
    has_reported_ = true;
    const double all_s = elapsed_s_ / share_;
    if (all_s < kLong_s) return "";
    const std::string all = "about " + duration_text(all_s);
    if (all_s <= goal_.seconds) return "that is expected to take " + all;
    return "that would take " + all + "; the picture ends after " + duration_text(goal_.seconds);
}

}  // namespace realcam::app
