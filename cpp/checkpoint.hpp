#pragma once
#include <chrono>
#include <cstddef>
#include <functional>
#include <utility>

#include "error.hpp"

namespace realcam {

/// Callback by which the caller of a long task can stop it. The task calls it at least every tenth of a second, on the
/// thread that started the task; if it returns false, the task throws Cancelled. An empty function never stops the
/// task.
using KeepGoing = std::function<bool()>;

/// Calls the KeepGoing of a long task about fifty times a second. The task reports its work in small units.
class Checkpoint {
public:
    explicit Checkpoint(KeepGoing keep_going = {}) : keep_going_(std::move(keep_going)) {}

    /// Reports `work` units of completed work; a unit takes a few nanoseconds to a microsecond. Throws Cancelled if
    /// KeepGoing returns false.
    void pass(std::size_t work = 1);

private:
    using Clock = std::chrono::steady_clock;
    /// Units of work between two readings of the clock, which take longer than a unit.
    static constexpr std::size_t kWorkBetweenClocks = 1 << 14;
    /// Time between two calls of KeepGoing.
    static constexpr std::chrono::milliseconds kTimeBetweenCalls{20};

    /// Calls KeepGoing if it is time.
    void read_clock();

    KeepGoing keep_going_;
    std::size_t work_ = 0;  ///< since the last reading of the clock
    Clock::time_point last_call_ = Clock::now();
};

}  // namespace realcam
