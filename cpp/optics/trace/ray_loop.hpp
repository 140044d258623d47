#pragma once
#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

#include "../../checkpoint.hpp"
#include "../../error.hpp"
#include "../../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Work on the rays [first, last).
using RayTask = std::function<void(std::size_t first, std::size_t last)>;

struct AimRequest;

/// Loop of an analysis over its rays. The default runs on the calling thread and cannot be cancelled. A program with
/// threads supplies a loop that uses them, and an interactive one supplies `keep_going`, which asks whether to
/// continue.
struct RayLoop {
    KeepGoing keep_going = {};  ///< exceptions that it throws end the analysis, too
    /// Calls the task for all of [first, last), in parts of any size and on any threads.
    std::function<void(std::size_t first, std::size_t last, const RayTask& task)> run =
        [](std::size_t first, std::size_t last, const RayTask& task) { task(first, last); };
    /// aim_rays on the calling thread, compiled for the machine's vector instructions; empty: as compiled in the
    /// caller.
    std::function<void(const AimRequest&)> aim_rays = {};

    /// Throws Cancelled if `keep_going` returns false.
    void heed() const {
        if (keep_going && !keep_going()) throw Cancelled();
    }
    /// Runs a task of at least a microsecond per ray. No ray's result may depend on another's.
    void for_all(std::size_t count, const RayTask& task) const {
        in_blocks(count, 1 << 14, [&](std::size_t first, std::size_t last) { run(first, last, task); });
    }
    /// Runs a task like for_all and appends the results: `results` grows block by block, because cancelling has to wait
    /// for an allocation.
    template <class T>
    void append_all(std::vector<T>& results, std::size_t count, const RayTask& task) const {
        results.reserve(count);
        in_blocks(count, 1 << 14, [&](std::size_t first, std::size_t last) {
            results.resize(last);
            run(first, last, task);
        });
    }
    /// Runs a task of nanoseconds per ray, on this thread and in order: sums do not depend on the number of threads.
    void in_order(std::size_t count, const RayTask& task) const { in_blocks(count, 1 << 20, task); }

private:
    template <class F>
    void in_blocks(std::size_t count, std::size_t block, F&& f) const {
        for (std::size_t first = 0; first < count; first += block) {
            heed();
            f(first, std::min(first + block, count));
        }
    }
};

}  // namespace REALCAM_NAMESPACE
