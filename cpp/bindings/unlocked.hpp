#pragma once
#include <pybind11/pybind11.h>

#include <optional>

namespace realcam::bindings {

/// Counts a call that works without the interpreter's lock. Python's end waits for those, because their threads may not
/// take the lock any more then; and a process that is forked meanwhile has lost their threads.
class WorkUnderWay {
public:
    /// Throws Cancelled while Python ends, and InputError in a process that was forked amid such work.
    WorkUnderWay();
    ~WorkUnderWay();
    WorkUnderWay(const WorkUnderWay&) = delete;
    WorkUnderWay& operator=(const WorkUnderWay&) = delete;
};

/// While it lives the thread does not hold the interpreter's lock, as with py::gil_scoped_release.
class Unlocked {
    WorkUnderWay work_;  // ends after the lock is taken again
    pybind11::gil_scoped_release release_;
};

/// In a process that was forked amid such work: what waits for its threads would wait for ever.
bool has_lost_threads();

/// Throws Cancelled while Python ends.
void stop_at_exit();

/// Python's end calls this as well, without the interpreter's lock: it stops what goes on without a call.
void stop_too_at_exit(void (*stop)());

/// Makes Python's end stop all work and wait for it; forked processes look whether they can work.
void watch_exit_and_fork();

}  // namespace realcam::bindings
