#include "analysis_arguments.hpp"

#include <cmath>

#include "../../math/hypotenuse.hpp"
#include "../bindings.hpp"

namespace realcam::bindings {

std::vector<PupilPoint> pattern_from(const std::string& pattern, int samples,
                                     const std::optional<InputArray<double>>& pupil) {
    if (pupil) {
        if (pupil->ndim() != 2 || pupil->shape(1) != 2 || pupil->shape(0) == 0)
            throw InputError("pupil must be an array of shape (N, 2), with N of 1 or more");
        std::vector<PupilPoint> points;
        const auto count = static_cast<std::size_t>(pupil->shape(0));
        points.reserve(count);
        RayLoop{heed_signals}.in_order(count, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) {
                const double x = pupil->data()[2 * i], y = pupil->data()[2 * i + 1];
                if (!(hypotenuse(x, y) < 10))
                    throw InputError("points of pupil must be in units of the stop's radius, below 10");
                points.push_back({x, y, 1});
            }
        });
        return points;
    }
    if (!(samples >= 1 && samples <= kMaxPatternSamples))
        throw InputError("samples must lie between 1 and " + std::to_string(kMaxPatternSamples));
    const RayLoop loop{heed_signals};
    if (pattern == "grid") return square_grid(samples, loop);
    if (pattern == "rings") return gauss_rings(samples, loop);
    if (pattern == "hexapolar") return hexapolar(samples, loop);
    throw InputError("unknown pattern \"" + pattern + "\"; expected grid, rings or hexapolar");
}

}  // namespace realcam::bindings
