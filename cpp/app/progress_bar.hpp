#pragma once
#include <chrono>
#include <string>

namespace realcam::app {

/// One line on stderr that is redrawn in place; silent if stderr is no terminal. The destructor clears it.
class ProgressBar {
public:
    explicit ProgressBar(std::string what, bool is_shown = true);
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;
    ~ProgressBar();

    /// `done`: 0 to 1. Draws at most ten times a second.
    void show(double done);
    /// Draws the elapsed seconds, for work of unknown length.
    void show_seconds();
    /// Clears the line, so that text can be printed.
    void clear();

private:
    /// Returns true, and records the time, if the line is due to be redrawn.
    bool is_due();

    using Clock = std::chrono::steady_clock;

    std::string what_;
    bool is_shown_, drawn_ = false;
    Clock::time_point start_, last_;
};

}  // namespace realcam::app
