#pragma once
#include <functional>

#include "../trace/lens_trace.hpp"

namespace REALCAM_NAMESPACE {

/// Backend of the pupil search: a ray tracer, which may use other vector instructions than the build's baseline, and a
/// parallel loop. The defaults use the baseline instructions and the calling thread. The pupil is bit-identical for any
/// number of threads.
struct PupilTracer {
    static constexpr int kBlock = 256;  ///< rays of a block
    using Rays = LensRays<float, kBlock>;
    using Task = std::function<void(int)>;

    /// Traces a block of rays from the film through a lens. Rays that leave the lens have the status 0 (RayStatus::ok).
    /// Several threads may call it at once.
    std::function<void(const LensView<float>&, Rays&)> trace = [](const LensView<float>& view, Rays& rays) {
        trace_lens(view, rays);
    };
    /// Calls task(0) to task(count - 1), in any order and on any threads. Returns when all calls have returned.
    std::function<void(int count, const Task& task)> for_each = [](int count, const Task& task) {
        for (int i = 0; i < count; ++i) task(i);
    };
};

}  // namespace REALCAM_NAMESPACE
