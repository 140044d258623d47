#pragma once
#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

#include "../../checkpoint.hpp"
#include "../../error.hpp"
#include "../../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Work of an analysis on the rays of index first to last - 1.
using RayTask = std::function<void(std::size_t first, std::size_t last)>;

struct AimRequest;

/// Loop of an analysis over its rays. The default runs on the calling thread and cannot be cancelled. A program with
/// threads supplies a loop that uses them, and an interactive one supplies `keep_going`, which returns false to cancel.
struct RayLoop {
    KeepGoing keep_going = {};  ///< called between blocks of rays; an exception that it throws ends the analysis, too
    /// Calls the task for all of [first, last), in parts of any size and on any threads.
    std::function<void(std::size_t first, std::size_t last, const RayTask& task)> run =
        [](std::size_t first, std::size_t last, const RayTask& task) { task(first, last); };
    /// The function aim_rays (cpp/optics/analysis/aim_request.hpp), compiled for the machine's vector instructions, on
    /// the calling thread; if empty, the caller uses its own copy, compiled for any machine.
    std::function<void(const AimRequest&)> aim_rays = {};

    /// Throws Cancelled if `keep_going` returns false.
    void throw_if_cancelled() const {
        if (keep_going && !keep_going()) throw Cancelled();
    }
    /// Runs a task of at least a microsecond per ray, by `run`, for the rays 0 to count - 1. No ray's result may depend
    /// on another's. Throws Cancelled.
    void for_all(std::size_t count, const RayTask& task) const {
        in_blocks(count, kBlock, [&](std::size_t first, std::size_t last) { run(first, last, task); });
    }
    /// Runs a task that writes result i to results[i], like for_all. `results` grows to `count` elements block by
    /// block, because one large allocation would delay a cancellation.
    template <class T>
    void append_all(std::vector<T>& results, std::size_t count, const RayTask& task) const {
        results.reserve(count);
        in_blocks(count, kBlock, [&](std::size_t first, std::size_t last) {
            results.resize(last);
            run(first, last, task);
        });
    }
    /// Runs a task of nanoseconds per ray on this thread and in order, so that sums do not depend on the number of
    /// threads. Throws Cancelled.
    void in_order(std::size_t count, const RayTask& task) const { in_blocks(count, kFastBlock, task); }

private:
    /// Numbers of rays between two calls of `keep_going`: some milliseconds of work.
    static constexpr std::size_t kBlock = 1 << 14, kFastBlock = 1 << 20;
    /// Calls f(first, last) for consecutive blocks of `block` rays, and throw_if_cancelled() before each.
    template <class F>
    void in_blocks(std::size_t count, std::size_t block, F&& f) const {
        for (std::size_t first = 0; first < count; first += block) {
            throw_if_cancelled();
            f(first, std::min(first + block, count));
        }
    }
};

}  // namespace REALCAM_NAMESPACE
