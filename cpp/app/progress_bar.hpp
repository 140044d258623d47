#pragma once
#include <chrono>
#include <string>

namespace realcam::app {

/// Progress on stderr, a line that is redrawn in place. Draws nothing if stderr is not a terminal. The destructor
/// clears the line.
class ProgressBar {
public:
    /// `label`: text at the start of the line. `is_shown`: false to draw nothing.
    explicit ProgressBar(std::string label, bool is_shown = true);
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;
    ~ProgressBar();

    /// Draws the completed fraction, 0 to 1, and the estimated remaining time. Draws at most ten times a second.
    void show(double done);
    /// Draws the elapsed seconds, for work of unknown length.
    void show_seconds();
    /// Clears the line, so that text can be printed.
    void clear();

private:
    /// Returns true, and records the time, if the line is due to be redrawn.
    bool is_due();

    using Clock = std::chrono::steady_clock;

    std::string label_;
    bool is_shown_, is_drawn_ = false;
    Clock::time_point start_, last_;
};

}  // namespace realcam::app
