#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "../error.hpp"
#include "interpolate_affine.hpp"

namespace REALCAM_NAMESPACE {

/// Largest accepted magnitude of a time: up to here a double resolves a tenth of a microsecond.
inline constexpr double kMostSeconds = 1e9;

/// Time interval, in seconds of the scene's clock.
struct TimeInterval {
    double begin_s = 0, end_s = 0;

    bool operator==(const TimeInterval&) const = default;
    double at(double share) const { return begin_s + share * (end_s - begin_s); }
};

/// Animated transform, by keyframes. Between two keys it is interpolated (see `interpolated`): a rotation takes the
/// shorter arc. It is constant before the first key and after the last.
struct Motion {
    std::vector<double> times_s;  ///< strictly increasing
    std::vector<Affine<double>> transforms;  ///< one per key

    bool operator==(const Motion&) const = default;

    Affine<double> at(double time_s) const;

    /// Returns the key times within an interval, without its ends.
    std::vector<double> times_within(const TimeInterval& interval) const;
};

/// Returns the times in increasing order, without duplicates.
std::vector<double> sorted_once(std::vector<double> times);

/// Returns why the time of a key is invalid, or an empty string. `last`: time of the key before it; null for the first
/// key.
std::string key_time_error(double time_s, const double* last);

/// Throws InputError, which names the key, if `check` does or if the key times are not strictly increasing. `of`: what
/// the keys animate, for the message ("the camera").
template <class Key, class Check>
void check_keys(const std::vector<Key>& keys, const std::string& of, Check&& check) {
    for (std::size_t k = 0; k < keys.size(); ++k) {
        const auto fail = [&](const std::string& why) {
            throw InputError("key " + std::to_string(k) + " of " + of + ": " + why);
        };
        const std::string why = key_time_error(keys[k].time_s, k > 0 ? &keys[k - 1].time_s : nullptr);
        if (!why.empty()) fail(why);
        try {
            check(keys[k]);
        } catch (const InputError& error) {
            fail(error.what());
        }
    }
}

/// Samples `at`, a function of time, as a motion: with keys at the given times, and as many between them as the
/// interpolation needs to follow it. For objects attached to a rotating one, which move along arcs.
template <class At>
Motion sampled_motion(const std::vector<double>& times_s, At&& at) {
    constexpr int kMostHalvings = 8;
    constexpr double kClose = 1e-5;  // of the axes' lengths and the distance moved: 1/100 of key_steps' tolerance
    Motion motion;
    const auto add = [&](double time, const Affine<double>& map) {
        motion.times_s.push_back(time);
        motion.transforms.push_back(map);
    };
    const auto is_close = [&](const Affine<double>& a, const Affine<double>& b, const Affine<double>& from) {
        const double axes = length(a.x) + length(a.y) + length(a.z);
        const double off = length(a.x - b.x) + length(a.y - b.y) + length(a.z - b.z);
        return off <= kClose * axes && length(a.origin - b.origin) <= kClose * (length(a.origin - from.origin) + axes);
    };
    const auto halve = [&](auto&& self, double begin, const Affine<double>& first, double end,
                           const Affine<double>& last, int depth) -> void {
        const double middle = 0.5 * (begin + end);
        const Affine<double> there = at(middle);
        if (depth < kMostHalvings && middle > begin && middle < end &&
            !is_close(there, interpolated(first, last, 0.5), first)) {
            self(self, begin, first, middle, there, depth + 1);
            self(self, middle, there, end, last, depth + 1);
        } else {
            add(end, last);
        }
    };
    for (std::size_t i = 0; i < times_s.size(); ++i) {
        const Affine<double> map = at(times_s[i]);
        if (i == 0)
            add(times_s[0], map);
        else
            halve(halve, times_s[i - 1], Affine<double>(motion.transforms.back()), times_s[i], map, 0);
    }
    return motion;
}

// Keys for kernels: transforms at uniform times of an interval, whose entries are interpolated linearly.

inline constexpr int kMostKeySteps = 128;  ///< Embree supports 129 keys

std::vector<Affine<double>> uniform_keys(const Motion& motion, const TimeInterval& interval, int steps);

/// Returns the number of steps between keys that keeps each of the points close to its position in the motion. The
/// tolerance is 1/1000 of the greatest displacement of a point, or 1e-5 of the distance between points if that is more.
/// 0: nothing moves. kMostKeySteps if these are too few for the tolerance, and std::nullopt if the error is then more
/// than a tenth of the displacement, because the motion has more than about twenty rotations.
std::optional<int> key_steps(const Motion& motion, const TimeInterval& interval, std::span<const Vec3d> points);

}  // namespace REALCAM_NAMESPACE
