#include "progress_bar.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace realcam::app {

ProgressBar::ProgressBar(std::string label, bool is_shown)
    : label_(std::move(label)),
      is_shown_(is_shown && isatty(STDERR_FILENO) != 0),
      start_(Clock::now()),
      last_(start_) {}

ProgressBar::~ProgressBar() {
    clear();
}

void ProgressBar::clear() {
    if (is_drawn_) std::fputs("\r\x1b[K", stderr);
    is_drawn_ = false;
}

bool ProgressBar::is_due() {
    const auto now = Clock::now();
    if (!is_shown_ || now - last_ < std::chrono::milliseconds(100)) return false;
    last_ = now;
    return is_drawn_ = true;
}

void ProgressBar::show_seconds() {
    if (!is_due()) return;
    std::fprintf(stderr, "\r%s %.0f s\x1b[K", label_.c_str(), std::chrono::duration<double>(last_ - start_).count());
    std::fflush(stderr);
}

void ProgressBar::show(double done) {
    if (!is_due()) return;
    constexpr int kWidth = 30;
    const int filled = std::clamp(static_cast<int>(done * kWidth), 0, kWidth);
    const std::string bar = std::string(static_cast<std::size_t>(filled), '#') +
                            std::string(static_cast<std::size_t>(kWidth - filled), '.');
    const double elapsed = std::chrono::duration<double>(last_ - start_).count();
    std::fprintf(stderr, "\r%s [%s] %3.0f%%", label_.c_str(), bar.c_str(), 100 * done);
    // The first estimates are too uncertain to show.
    if (done > 0.02) std::fprintf(stderr, ", %.0f s left", elapsed * (1 - done) / done);
    std::fputs("\x1b[K", stderr);
    std::fflush(stderr);
}

}  // namespace realcam::app
