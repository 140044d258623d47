#include "fast_pupil_tracer.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "kernels.hpp"

namespace realcam {

PupilTracer fast_pupil_tracer() {
    const auto trace = kernels().trace_block;
    return {[trace](const LensView<float>& view, PupilTracer::Rays& rays) { trace(&view, &rays); },
            [](int count, const PupilTracer::Task& task) {
                tbb::parallel_for(
                    tbb::blocked_range<int>(0, count, 1),
                    [&](const tbb::blocked_range<int>& range) {
                        for (int i = range.begin(); i < range.end(); ++i) task(i);
                    },
                    tbb::simple_partitioner());
            }};
}

}  // namespace realcam
