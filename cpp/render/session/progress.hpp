#pragma once
#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include "../../checkpoint.hpp"
#include "../../error.hpp"
#include "../../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Wall-clock seconds since `start`.
inline double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Called about 20 times a second on the thread that began the work. `done`: from 0 to 1. Returns false to stop the
/// work.
using Progress = std::function<bool(double done)>;

namespace run_with_progress_detail {

template <class Work>
std::thread started(Work&& work) {
    try {
        return std::thread(std::forward<Work>(work));
    } catch (const std::system_error&) {
        throw NoThread();
    }
}

}  // namespace run_with_progress_detail

/// Runs `work` on a thread of its own, while the caller's thread calls `keep_going`, and sets `stop` once that returns
/// false or throws. `stop`: an std::atomic<bool>, or a type that is assigned `true` and read in the same way.
template <class Work, class Stop>
void run_heeding(Work&& work, const KeepGoing& keep_going, Stop& stop) {
    if (!keep_going) {
        work();
        return;
    }
    std::mutex mutex;
    std::condition_variable finished;
    bool over = false;
    std::exception_ptr failure;
    std::thread worker = run_with_progress_detail::started([&] {
        try {
            work();
        } catch (...) {
            failure = std::current_exception();
        }
        const std::lock_guard lock(mutex);
        over = true;
        finished.notify_all();
    });
    std::exception_ptr callers_failure;
    std::unique_lock lock(mutex);
    while (!finished.wait_for(lock, std::chrono::milliseconds(50), [&] { return over; })) {
        lock.unlock();
        try {
            if (!stop && !keep_going()) stop = true;
        } catch (...) {
            callers_failure = std::current_exception();
            stop = true;
        }
        lock.lock();
    }
    lock.unlock();
    worker.join();
    if (callers_failure) std::rethrow_exception(callers_failure);
    if (failure) std::rethrow_exception(failure);
}

/// run_heeding for work with progress; `share()`: the fraction done, from 0 to 1. The end is reported, too.
template <class Work, class Share, class Stop>
void run_with_progress(Work&& work, Share&& share, const Progress& progress, Stop& stop) {
    run_heeding(work, progress ? KeepGoing([&] { return progress(share()); }) : KeepGoing(), stop);
    if (progress && !stop) progress(1.0);
}

}  // namespace REALCAM_NAMESPACE
