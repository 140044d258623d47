#include "checkpoint.hpp"

namespace realcam {

void Checkpoint::pass(std::size_t work) {
    work_ += work;
    if (work_ >= kWorkBetweenClocks) look_at_clock();
}

void Checkpoint::look_at_clock() {
    work_ = 0;
    const Clock::time_point now = Clock::now();
    if (!keep_going_ || now - last_ < kBetweenQuestions) return;
    last_ = now;
    if (!keep_going_()) throw Cancelled();
}

}  // namespace realcam
