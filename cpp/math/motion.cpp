#include "motion.hpp"

#include <algorithm>
#include <cmath>

namespace realcam {

Affine<double> Motion::at(double time_s) const {
    const auto next = std::upper_bound(times_s.begin(), times_s.end(), time_s);
    if (next == times_s.begin()) return transforms.front();
    const auto i = static_cast<std::size_t>(next - times_s.begin()) - 1;
    if (next == times_s.end() || time_s == times_s[i]) return transforms[i];
    return interpolated(transforms[i], transforms[i + 1], (time_s - times_s[i]) / (times_s[i + 1] - times_s[i]));
}

std::vector<double> Motion::times_within(const TimeInterval& interval) const {
    return {std::upper_bound(times_s.begin(), times_s.end(), interval.begin_s),
            std::lower_bound(times_s.begin(), times_s.end(), std::max(interval.begin_s, interval.end_s))};
}

std::vector<double> sorted_once(std::vector<double> times) {
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    return times;
}

std::string key_time_error(double time_s, const double* last) {
    if (!(std::fabs(time_s) <= kMostSeconds)) return "a time must lie within 1e9 s";
    return last && !(*last < time_s) ? "the times must rise" : "";
}

}  // namespace realcam
