#include "sensor_exposure.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "../error.hpp"
#include "kernels.hpp"

namespace realcam {
namespace {

/// Computes some rows of a request on the calling thread.
void expose_band(const SensorRequest& all, std::int32_t first_row, std::int32_t end_row) {
    SensorRequest band = all;
    const auto skipped = static_cast<std::ptrdiff_t>(first_row - all.first_row) * all.width;
    band.exposure += 3 * skipped;
    band.raw += skipped;
    band.first_row = first_row;
    band.row_count = end_row - first_row;
    kernels().expose_sensor(&band);
}

}  // namespace

void expose_sensor(const SensorRequest& request, int threads, const KeepGoing& keep_going) {
    // For more threads than cores, TBB writes a warning to the console and starts only as many as there are cores.
    const int cores = tbb::this_task_arena::max_concurrency();
    tbb::task_arena arena(threads > 0 ? std::min(threads, cores) : cores);
    const std::int32_t step = std::max(1, (1 << 21) / request.width);  // some 0.1 s of one core
    const std::int32_t end = request.first_row + request.row_count;
    for (std::int32_t first = request.first_row; first < end; first += step) {
        if (keep_going && !keep_going()) throw Cancelled();
        const std::int32_t last = std::min(first + step, end);
        arena.execute([&] {
            tbb::parallel_for(
                tbb::blocked_range<std::int32_t>(first, last, 8),
                [&](const tbb::blocked_range<std::int32_t>& rows) { expose_band(request, rows.begin(), rows.end()); });
        });
    }
}

}  // namespace realcam
