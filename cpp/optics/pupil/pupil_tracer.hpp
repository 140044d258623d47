#pragma once
#include <functional>

#include "../trace/lens_trace.hpp"

namespace REALCAM_NAMESPACE {

/// Backend of the pupil search: vector instructions and threads. The default is the build's baseline instruction set on
/// the calling thread. The pupil is bit-identical for any number of threads.
struct PupilTracer {
    static constexpr int kBlock = 256;
    using Rays = LensRays<float, kBlock>;
    using Task = std::function<void(int)>;

    /// Traces float rays from the film of one lens; their status says which leave it. Several threads may call it.
    std::function<void(const LensView<float>&, Rays&)> trace = [](const LensView<float>& view, Rays& rays) {
        trace_lens(view, rays);
    };
    /// Calls task(0) to task(count - 1), in any order and on any threads, and returns when all are done.
    std::function<void(int count, const Task& task)> for_each = [](int count, const Task& task) {
        for (int i = 0; i < count; ++i) task(i);
    };
};

}  // namespace REALCAM_NAMESPACE
