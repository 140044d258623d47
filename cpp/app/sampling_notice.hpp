#pragma once
#include <chrono>
#include <string>

#include "../shot/shot_request.hpp"

namespace realcam::app {

/// Messages about the expected duration of a picture with a noise goal.
class SamplingNotice {
public:
    SamplingNotice(const NoiseGoal& goal, shot::Sampling sampling) : goal_(goal), sampling_(sampling) {}

    /// The noise goal and the time limit, in a line.
    std::string aim() const;

    /// Records that a fraction of the samples is taken, from 0 to 1. Returns the fraction done: the larger of `share`
    /// and the elapsed fraction of the time limit.
    double took(double share);

    /// The expected duration, in a line, the first time it can be estimated. Empty at other times and for short
    /// durations.
    std::string expectation();

private:
    using Clock = std::chrono::steady_clock;

    NoiseGoal goal_;
    shot::Sampling sampling_;
    Clock::time_point start_ = Clock::now();
    double elapsed_s_ = 0, share_ = 0;
    bool has_reported_ = false;
};

}  // namespace realcam::app
