#pragma once
#include <chrono>
#include <string>

namespace realcam::app {

/// One line on stderr that rewrites itself; silent where stderr is no terminal. It goes away when it is destroyed.
class ProgressBar {
public:
    explicit ProgressBar(std::string what, bool is_shown = true);
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;
    ~ProgressBar();

    /// `done`: 0 to 1. Draws at most ten times a second.
    void show(double done);
    /// Draws the seconds that have passed, for work of unknown length.
    void show_seconds();
    /// Makes way for a line of text.
    void clear();

private:
    /// Returns true, and takes note of the time, if the line is to be drawn again.
    bool is_due();

    using Clock = std::chrono::steady_clock;

    std::string what_;
    bool is_shown_, drawn_ = false;
    Clock::time_point start_, last_;
};

}  // namespace realcam::app
