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

/// Returns the wall-clock seconds since `start`.
inline double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Callback of long work, called about 20 times a second on the thread that began it. `done`: fraction of the work that
/// is complete, from 0 to 1. Returns false to stop the work.
using Progress = std::function<bool(double done)>;

namespace run_with_progress_detail {

/// Starts a thread. Throws NoThread if the system cannot.
template <class Work>
std::thread start_thread(Work&& work) {
    try {
        return std::thread(std::forward<Work>(work));
    } catch (const std::system_error&) {
        throw NoThread();
    }
}

}  // namespace run_with_progress_detail

/// Runs `work` on a thread of its own while the caller's thread calls `keep_going`, and assigns true to `stop` once
/// that returns false or throws. Returns when `work` has ended, which must watch `stop`; rethrows the exception of
/// `keep_going` or of `work`. Without `keep_going`, runs `work` on the caller's thread. `stop`: a std::atomic<bool>, or
/// a type that is assigned `true` and read in the same way.
template <class Work, class Stop>
void run_interruptibly(Work&& work, const KeepGoing& keep_going, Stop& stop) {
    if (!keep_going) {
        work();
        return;
    }
    std::mutex mutex;
    std::condition_variable finished;
    bool is_finished = false;
    std::exception_ptr failure;
    std::thread worker = run_with_progress_detail::start_thread([&] {
        try {
            work();
        } catch (...) {
            failure = std::current_exception();
        }
        const std::lock_guard lock(mutex);
        is_finished = true;
        finished.notify_all();
    });
    std::exception_ptr keep_going_failure;
    std::unique_lock lock(mutex);
    while (!finished.wait_for(lock, std::chrono::milliseconds(50), [&] { return is_finished; })) {
        lock.unlock();
        try {
            if (!stop && !keep_going()) stop = true;
        } catch (...) {
            keep_going_failure = std::current_exception();
            stop = true;
        }
        lock.lock();
    }
    lock.unlock();
    worker.join();
    if (keep_going_failure) std::rethrow_exception(keep_going_failure);
    if (failure) std::rethrow_exception(failure);
}

/// run_interruptibly with progress reports; `share()`: returns the fraction of the work that is complete, from 0 to 1.
/// Reports 1 at the end.
template <class Work, class Share, class Stop>
void run_with_progress(Work&& work, Share&& share, const Progress& progress, Stop& stop) {
    run_interruptibly(work, progress ? KeepGoing([&] { return progress(share()); }) : KeepGoing(), stop);
    if (progress && !stop) progress(1.0);
}

}  // namespace REALCAM_NAMESPACE
