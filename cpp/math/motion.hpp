#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "../error.hpp"
#include "interpolate_affine.hpp"

// Keyframe animation of transforms, and its conversion to uniform keys for kernels.

namespace REALCAM_NAMESPACE {

/// Largest accepted magnitude of a time, s: up to here a double resolves a tenth of a microsecond.
inline constexpr double kMaxTime_s = 1e9;

/// Time interval, in seconds of the scene's clock.
struct TimeInterval {
    double begin_s = 0, end_s = 0;

    bool operator==(const TimeInterval&) const = default;
    /// Returns the time at a fraction of the interval, s.
    double at(double fraction) const { return begin_s + fraction * (end_s - begin_s); }
};

/// Animated transform, by keyframes. Between two keys it is interpolated (see `interpolated`): a rotation takes the
/// shorter arc. It is constant before the first key and after the last.
struct Motion {
    std::vector<double> times_s;  ///< strictly increasing
    std::vector<Affine<double>> transforms;  ///< one per key

    bool operator==(const Motion&) const = default;

    /// Returns the transform at a time.
    Affine<double> at(double time_s) const;

    /// Returns the key times that lie strictly inside an interval.
    std::vector<double> times_within(const TimeInterval& interval) const;
};

/// Returns the times in increasing order, without duplicates.
std::vector<double> sorted_unique(std::vector<double> times);

/// Returns the reason why the time of a key is invalid, or an empty string if it is valid. `previous`: time of the
/// previous key; null for the first key.
std::string key_time_error(double time_s, const double* previous);

/// Throws InputError if the key times (member `time_s`) are not strictly increasing, or if check(key) throws
/// InputError. The message names the key by its index and by `subject`, the animated object, such as "the camera".
template <class Key, class Check>
void check_keys(const std::vector<Key>& keys, const std::string& subject, Check&& check) {
    for (std::size_t k = 0; k < keys.size(); ++k) {
        const auto fail = [&](const std::string& why) {
            throw InputError("key " + std::to_string(k) + " of " + subject + ": " + why);
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

/// Converts a function of time, `transform_at`(time_s), to a motion. Its keys are at the given times, and at additional
/// times between them where the interpolation would deviate. Used for objects attached to a rotating object, which move
/// along arcs.
template <class TransformAt>
Motion sampled_motion(const std::vector<double>& times_s, TransformAt&& transform_at) {
    constexpr int kMaxHalvings = 8;  // largest number of bisections between two given times
    // Tolerance relative to the lengths of the axes and the distance moved: 1/100 of the tolerance of key_steps.
    constexpr double kTolerance = 1e-5;
    Motion motion;
    const auto add = [&](double time, const Affine<double>& map) {
        motion.times_s.push_back(time);
        motion.transforms.push_back(map);
    };
    const auto is_close = [&](const Affine<double>& a, const Affine<double>& b, const Affine<double>& from) {
        const double axes = length(a.x) + length(a.y) + length(a.z);
        const double deviation = length(a.x - b.x) + length(a.y - b.y) + length(a.z - b.z);
        return deviation <= kTolerance * axes &&
               length(a.origin - b.origin) <= kTolerance * (length(a.origin - from.origin) + axes);
    };
    const auto subdivide = [&](auto&& self, double begin, const Affine<double>& first, double end,
                               const Affine<double>& last, int depth) -> void {
        const double middle = 0.5 * (begin + end);
        const Affine<double> middle_map = transform_at(middle);
        if (depth < kMaxHalvings && middle > begin && middle < end &&
            !is_close(middle_map, interpolated(first, last, 0.5), first)) {
            self(self, begin, first, middle, middle_map, depth + 1);
            self(self, middle, middle_map, end, last, depth + 1);
        } else {
            add(end, last);
        }
    };
    for (std::size_t i = 0; i < times_s.size(); ++i) {
        const Affine<double> map = transform_at(times_s[i]);
        if (i == 0)
            add(times_s[0], map);
        else
            subdivide(subdivide, times_s[i - 1], Affine<double>(motion.transforms.back()), times_s[i], map, 0);
    }
    return motion;
}

// Kernels interpolate linearly, entry by entry, between keys at uniform times of an interval.

inline constexpr int kMaxKeySteps = 128;  ///< largest number of steps: Embree supports 129 keys

/// Returns the transforms at steps + 1 uniform times of an interval, including its ends.
std::vector<Affine<double>> uniform_keys(const Motion& motion, const TimeInterval& interval, int steps);

/// Returns the number of steps of uniform_keys, a power of two, with which linear interpolation keeps each of the
/// points close to its true position; 0 if no point moves. The tolerance is 1/1000 of the largest displacement of a
/// point, or 1e-5 of the largest distance from the first point to another if that is more. Returns kMaxKeySteps if no
/// number of steps meets the tolerance. Returns std::nullopt if the error would then exceed a tenth of the
/// displacement, as for motions of more than about twenty rotations.
std::optional<int> key_steps(const Motion& motion, const TimeInterval& interval, std::span<const Vec3d> points);

}  // namespace REALCAM_NAMESPACE
