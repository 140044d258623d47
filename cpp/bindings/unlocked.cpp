#include "unlocked.hpp"

#include <pthread.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "../error.hpp"

namespace realcam::bindings {

namespace py = pybind11;

namespace {

// Atomics instead of a mutex: a mutex held by another thread would stay locked in a forked process.
std::atomic<int> in_progress{0};  ///< number of living WorkInProgress objects
std::atomic<bool> is_exiting{false}, lost_threads{false};

/// Returns the functions registered by call_at_exit.
std::vector<void (*)()>& exit_functions() {
    static auto* const list = new std::vector<void (*)()>;
    return *list;
}

void wait_for_all_work() {
    using namespace std::chrono_literals;
    is_exiting = true;
    const py::gil_scoped_release release;
    for (void (*const stop)() : exit_functions()) stop();
    // Work checks 20 times a second whether Python exits. The wait is limited, because a user's progress function that
    // does not return must not delay the exit for ever.
    for (auto waited = 0ms; in_progress > 0 && waited < 10s; waited += 5ms) std::this_thread::sleep_for(5ms);
}

}  // namespace

WorkInProgress::WorkInProgress() {
    stop_at_exit();
    if (lost_threads)
        throw InputError(
            "this process was forked while another thread was running realcam, and cannot use realcam itself; fork "
            "earlier, or start processes with the method \"spawn\"");
    ++in_progress;
}

WorkInProgress::~WorkInProgress() {
    --in_progress;
}

bool has_lost_threads() {
    return lost_threads;
}

void stop_at_exit() {
    if (is_exiting) throw Cancelled();
}

void call_at_exit(void (*stop)()) {
    exit_functions().push_back(stop);
}

void watch_exit_and_fork() {
    py::module_::import("atexit").attr("register")(py::cpp_function(&wait_for_all_work));
    pthread_atfork(nullptr, nullptr, [] {
        // The forked child lacks the threads that would finish the work in progress, so its exit must not wait for
        // them.
        if (in_progress.exchange(0) > 0) lost_threads = true;
    });
}

}  // namespace realcam::bindings
