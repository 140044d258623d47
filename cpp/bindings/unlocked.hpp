#pragma once
#include <pybind11/pybind11.h>

#include <optional>

namespace realcam::bindings {

/// Counts a call that runs without the GIL. Python's exit waits for these calls, because their threads can no longer
/// take the GIL afterwards; and a process that is forked meanwhile lacks their threads.
class WorkInProgress {
public:
    /// Throws Cancelled while Python exits, and InputError in a process that was forked during a call without the GIL.
    WorkInProgress();
    ~WorkInProgress();
    WorkInProgress(const WorkInProgress&) = delete;
    WorkInProgress& operator=(const WorkInProgress&) = delete;
};

/// Releases the GIL for its lifetime, like py::gil_scoped_release.
class Unlocked {
    WorkInProgress work_;  // destroyed after the GIL has been reacquired
    pybind11::gil_scoped_release release_;
};

/// Returns true in a process that was forked during a call without the GIL. It lacks that call's threads, so that
/// waiting for them would never end.
bool has_lost_threads();

/// Throws Cancelled while Python exits.
void stop_at_exit();

/// Registers a function that Python's exit calls without the GIL, to stop background work outside of any call.
void call_at_exit(void (*stop)());

/// Makes Python's exit stop all work and wait for it, and makes forked processes detect whether threads were lost.
void watch_exit_and_fork();

}  // namespace realcam::bindings
