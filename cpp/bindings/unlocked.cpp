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
std::atomic<int> in_progress{0};
std::atomic<bool> ends{false}, lost_threads{false};

std::vector<void (*)()>& others() {
    static auto* const list = new std::vector<void (*)()>;
    return *list;
}

void wait_for_all_work() {
    using namespace std::chrono_literals;
    ends = true;
    const py::gil_scoped_release release;
    for (void (*const stop)() : others()) stop();
    // Work checks 20 times a second whether Python exits. A user's progress function that does not return must not
    // delay the exit for ever.
    for (auto waited = 0ms; in_progress > 0 && waited < 10s; waited += 5ms) std::this_thread::sleep_for(5ms);
}

}  // namespace

WorkInProgress::WorkInProgress() {
    stop_at_exit();
    if (lost_threads)
        throw InputError(
            "this process was forked while another thread was at work in realcam, and cannot work itself; fork before, "
            "or start processes with the method \"spawn\"");
    ++in_progress;
}

WorkInProgress::~WorkInProgress() {
    --in_progress;
}

bool has_lost_threads() {
    return lost_threads;
}

void stop_at_exit() {
    if (ends) throw Cancelled();
}

void stop_too_at_exit(void (*stop)()) {
    others().push_back(stop);
}

void watch_exit_and_fork() {
    py::module_::import("atexit").attr("register")(py::cpp_function(&wait_for_all_work));
    pthread_atfork(nullptr, nullptr, [] {
        // The child lacks the threads that would finish that work, so its exit must not wait for them.
        if (in_progress.exchange(0) > 0) lost_threads = true;
    });
}

}  // namespace realcam::bindings
