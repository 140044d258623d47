#include "checkpoint.hpp"

namespace realcam {

void Checkpoint::pass(std::size_t work) {
    work_ += work;
    if (work_ >= kWorkBetweenClocks) read_clock();
}

void Checkpoint::read_clock() {
    work_ = 0;
    const Clock::time_point now = Clock::now();
    if (!keep_going_ || now - last_call_ < kTimeBetweenCalls) return;
    last_call_ = now;
    if (!keep_going_()) throw Cancelled();
}

}  // namespace realcam
