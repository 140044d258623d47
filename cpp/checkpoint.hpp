#pragma once
#include <chrono>
#include <cstddef>
#include <functional>
#include <utility>

#include "error.hpp"

namespace realcam {

/// Called by long tasks at least every tenth of a second, on the thread that started them; if it returns false, the
/// task ends by throwing Cancelled. Empty: the task is never stopped.
using KeepGoing = std::function<bool()>;

/// Asks the caller of a long task, about fifty times a second, whether to go on.
class Checkpoint {
public:
    /// An empty function never stops the task.
    explicit Checkpoint(KeepGoing keep_going = {}) : keep_going_(std::move(keep_going)) {}

    /// Reports work done; a unit takes a few nanoseconds to a microsecond. Throws Cancelled if the caller wants to
    /// stop.
    void pass(std::size_t work = 1);

private:
    using Clock = std::chrono::steady_clock;
    static constexpr std::size_t kWorkBetweenClocks = 1 << 14;
    static constexpr std::chrono::milliseconds kBetweenQuestions{20};

    void look_at_clock();

    KeepGoing keep_going_;
    std::size_t work_ = 0;
    Clock::time_point last_ = Clock::now();
};

}  // namespace realcam
