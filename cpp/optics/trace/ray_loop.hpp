#pragma once
#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

#include "../../error.hpp"
#include "../../keep_going.hpp"
#include "../../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Work on the rays [first, last).
using RayTask = std::function<void(std::size_t first, std::size_t last)>;

struct AimRequest;

/// How an analysis goes through its rays: on the calling thread, and not to be stopped. A program that has threads
/// brings a loop that uses them, and one whose user may lose patience asks him in `keep_going`.
struct RayLoop {
    KeepGoing keep_going = {};  ///< what it throws ends the analysis too
    /// Calls the task for all of [first, last), in parts of any size and on any threads.
    std::function<void(std::size_t first, std::size_t last, const RayTask& task)> run =
        [](std::size_t first, std::size_t last, const RayTask& task) { task(first, last); };
    /// aim_rays on the calling thread, built for the vectors that the machine has; none: as the caller is built.
    std::function<void(const AimRequest&)> aim_rays = {};

    /// Throws Cancelled where the caller wants to stop.
    void heed() const {
        if (keep_going && !keep_going()) throw Cancelled();
    }
    /// For work of a microsecond or more a ray. No ray's result may depend on another's.
    void for_all(std::size_t count, const RayTask& task) const {
        in_blocks(count, 1 << 14, [&](std::size_t first, std::size_t last) { run(first, last, task); });
    }
    /// The same, with the results appended: large memory is taken block by block, because a stop has to wait for it.
    template <class T>
    void append_all(std::vector<T>& results, std::size_t count, const RayTask& task) const {
        results.reserve(count);
        in_blocks(count, 1 << 14, [&](std::size_t first, std::size_t last) {
            results.resize(last);
            run(first, last, task);
        });
    }
    /// For work of nanoseconds a ray, on this thread and in order: sums come out the same whatever the threads.
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
