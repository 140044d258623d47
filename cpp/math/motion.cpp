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

std::vector<double> sorted_unique(std::vector<double> times) {
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    return times;
}

std::string key_time_error(double time_s, const double* previous) {
    if (!(std::fabs(time_s) <= kMaxTime_s)) return "a time must lie within 1e9 s";
    return previous && !(*previous < time_s) ? "the times must be strictly increasing" : "";
}

std::vector<Affine<double>> uniform_keys(const Motion& motion, const TimeInterval& interval, int steps) {
    std::vector<Affine<double>> keys;
    for (int k = 0; k <= steps; ++k) keys.push_back(motion.at(interval.at(static_cast<double>(k) / steps)));
    return keys;
}

std::optional<int> key_steps(const Motion& motion, const TimeInterval& interval, std::span<const Vec3d> points) {
    // Tolerances, relative to the displacement and to the extent of the points, and the largest error relative to the
    // displacement.
    constexpr double kOfDisplacement = 1e-3, kOfExtent = 1e-5, kMaxError = 0.1;
    // Positions are compared at the keys of the motion and at sevenths between them. For any power of two of steps
    // these lie at sevenths of a step, some of them near its middle, where the error of linear interpolation is
    // largest.
    std::vector<double> times = {interval.begin_s};
    const auto add_times_until = [&](double end) {
        const double begin = times.back();
        for (int k = 1; k <= 7; ++k) times.push_back(begin + (end - begin) * k / 7);
    };
    for (const double key : motion.times_within(interval)) add_times_until(key);
    if (interval.end_s > interval.begin_s) add_times_until(interval.end_s);
    std::vector<Affine<double>> maps;
    for (const double time : times) maps.push_back(motion.at(time));
    const auto largest_distance = [&](const Affine<double>& a, const Affine<double>& b) {
        double largest = 0;
        for (const Vec3d p : points) largest = std::max(largest, length(a.point(p) - b.point(p)));
        return largest;
    };
    double displacement = 0, extent = 0, distance_from_origin = 0;
    for (const auto& map : maps) displacement = std::max(displacement, largest_distance(map, maps[0]));
    for (const Vec3d p : points) distance_from_origin = std::max(distance_from_origin, length(maps[0].point(p)));
    constexpr double kRounding = 1e-14;  // relative to the distance from the origin, for points at rest
    if (displacement <= kRounding * distance_from_origin) return 0;
    for (const Vec3d p : points) extent = std::max(extent, length(maps[0].direction(p - points[0])));
    const double tolerance = std::max(kOfDisplacement * displacement, kOfExtent * extent);
    for (int steps = 1;; steps *= 2) {
        const std::vector<Affine<double>> keys = uniform_keys(motion, interval, steps);
        const double max_error = steps < kMaxKeySteps ? tolerance : std::max(kMaxError * displacement, tolerance);
        double largest = 0;
        for (std::size_t i = 0; i < times.size() && largest <= max_error; ++i) {
            const double position = (times[i] - interval.begin_s) / (interval.end_s - interval.begin_s) * steps;
            const auto k = static_cast<std::size_t>(std::clamp(std::floor(position), 0.0, steps - 1.0));
            const double fraction = position - static_cast<double>(k);
            largest = std::max(largest, largest_distance(maps[i], mix(keys[k], keys[k + 1], fraction)));
        }
        if (largest <= max_error) return steps;
        if (steps == kMaxKeySteps) return std::nullopt;
    }
}

}  // namespace realcam
