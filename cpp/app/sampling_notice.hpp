#pragma once
#include <chrono>
#include <string>

#include "../shot/shot_request.hpp"

namespace realcam::app {

/// What a picture that is to have little noise tells of how long it takes.
class SamplingNotice {
public:
    SamplingNotice(const NoiseGoal& goal, shot::Sampling sampling) : goal_(goal), sampling_(sampling) {}

    /// What the samples go on until, and after which time they end all the same; a line.
    std::string aim() const;

    /// Takes note that a share of the samples is taken, from 0 to 1. Returns the share of the time.
    double took(double share);

    /// How long that is expected to last, when there is something to go by; a line, once. Empty: not now.
    std::string expectation();

private:
    using Clock = std::chrono::steady_clock;

    NoiseGoal goal_;
    shot::Sampling sampling_;
    Clock::time_point start_ = Clock::now();
    double elapsed_s_ = 0, share_ = 0;
    bool has_told_ = false;
};

}  // namespace realcam::app
