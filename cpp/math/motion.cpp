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

std::vector<Affine<double>> uniform_keys(const Motion& motion, const TimeInterval& interval, int steps) {
    std::vector<Affine<double>> keys;
    for (int k = 0; k <= steps; ++k) keys.push_back(motion.at(interval.at(static_cast<double>(k) / steps)));
    return keys;
}

std::optional<int> key_steps(const Motion& motion, const TimeInterval& interval, std::span<const Vec3d> points) {
    constexpr double kOfPath = 1e-3, kOfSize = 1e-5, kTooFar = 0.1;
    // The path is checked at the motion's own keys, and at sevenths between them, which also lie at sevenths of every
    // power of two of steps, and so near the middles of some.
    std::vector<double> times = {interval.begin_s};
    const auto look_until = [&](double end) {
        const double begin = times.back();
        for (int k = 1; k <= 7; ++k) times.push_back(begin + (end - begin) * k / 7);
    };
    for (const double key : motion.times_within(interval)) look_until(key);
    if (interval.end_s > interval.begin_s) look_until(interval.end_s);
    std::vector<Affine<double>> path;
    for (const double time : times) path.push_back(motion.at(time));
    const auto farthest = [&](const Affine<double>& a, const Affine<double>& b) {
        double most = 0;
        for (const Vec3d p : points) most = std::max(most, length(a.point(p) - b.point(p)));
        return most;
    };
    double path_length = 0, size = 0, reach = 0;
    for (const auto& map : path) path_length = std::max(path_length, farthest(map, path[0]));
    for (const Vec3d p : points) reach = std::max(reach, length(path[0].point(p)));
    constexpr double kRounding = 1e-14;  // relative to the distance from the origin, for points at rest
    if (path_length <= kRounding * reach) return 0;
    for (const Vec3d p : points) size = std::max(size, length(path[0].direction(p - points[0])));
    const double close = std::max(kOfPath * path_length, kOfSize * size);
    for (int steps = 1;; steps *= 2) {
        const std::vector<Affine<double>> keys = uniform_keys(motion, interval, steps);
        const double wanted = steps < kMostKeySteps ? close : std::max(kTooFar * path_length, close);
        double most = 0;
        for (std::size_t i = 0; i < times.size() && most <= wanted; ++i) {
            const double position = (times[i] - interval.begin_s) / (interval.end_s - interval.begin_s) * steps;
            const auto k = static_cast<std::size_t>(std::clamp(std::floor(position), 0.0, steps - 1.0));
            const double share = position - static_cast<double>(k);
            most = std::max(most, farthest(path[i], mix(keys[k], keys[k + 1], share)));
        }
        if (most <= wanted) return steps;
        if (steps == kMostKeySteps) return std::nullopt;
    }
}

}  // namespace realcam
