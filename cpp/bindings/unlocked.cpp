#include "unlocked.hpp"

#include <pthread.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "../error.hpp"

namespace realcam::bindings {

namespace py = pybind11;

namespace {

// No mutex: one that another thread holds would stay locked in a forked process.
std::atomic<int> under_way{0};
std::atomic<bool> ends{false}, lost_threads{false};

void wait_for_all_work() {
    using namespace std::chrono_literals;
    ends = true;
    const py::gil_scoped_release release;
    // Work looks up 20 times a second. A user's progress function that does not return must not keep Python for ever.
    for (auto waited = 0ms; under_way > 0 && waited < 10s; waited += 5ms) std::this_thread::sleep_for(5ms);
}

}  // namespace

WorkUnderWay::WorkUnderWay() {
    stop_at_exit();
    if (lost_threads)
        throw InputError(
            "this process was forked while another thread was at work in realcam, and cannot work itself; fork before, "
            "or start processes with the method \"spawn\"");
    ++under_way;
}

WorkUnderWay::~WorkUnderWay() {
    --under_way;
}

void stop_at_exit() {
    if (ends) throw Cancelled();
}

void watch_exit_and_fork() {
    py::module_::import("atexit").attr("register")(py::cpp_function(&wait_for_all_work));
    pthread_atfork(nullptr, nullptr, [] {
        if (under_way > 0) lost_threads = true;
    });
}

}  // namespace realcam::bindings
