#include "keyframes.hpp"

#include <algorithm>
#include <cmath>

#include "motion.hpp"

namespace realcam {
namespace {

/// Position of a time among keys: index of the key before it, fraction of the interval to the next key, and that
/// interval's length in seconds.
struct KeyPosition {
    std::size_t first;
    double fraction, seconds;
};

/// Returns the position of a time; before the first key and after the last, that of the key itself.
KeyPosition key_position(double time, const std::vector<double>& times) {
    const auto next = std::upper_bound(times.begin(), times.end(), time);
    if (next == times.begin()) return {0, 0, 0};
    const auto first = static_cast<std::size_t>(next - times.begin()) - 1;
    if (next == times.end()) return {first, 0, 0};
    const double seconds = *next - times[first];
    return {first, (time - times[first]) / seconds, seconds};
}

/// Writes the weighted sum of four consecutive vectors of VectorKeys::values. `first`: index of the first vector.
void add_vectors(const VectorKeys& keys, std::size_t first, const double (&weights)[4], double* out) {
    const float* values = keys.values.data() + first * keys.components;
    for (std::size_t c = 0; c < keys.components; ++c) {
        out[c] = 0;
        for (std::size_t i = 0; i < 4; ++i)
            if (weights[i] != 0) out[c] += weights[i] * static_cast<double>(values[i * keys.components + c]);
    }
}

/// Returns a translation or scale at a time.
Vec3d vector_at(const VectorKeys& keys, double time) {
    double v[3];
    keys.at(time, v);
    return {v[0], v[1], v[2]};
}

Quaternion unit(const double (&q)[4]) {
    const Quaternion quaternion = {{q[0], q[1], q[2]}, q[3]};
    const double size = std::sqrt(dot(quaternion, quaternion));
    return size > 0 ? (1 / size) * quaternion : Quaternion{};
}

/// Returns a rotation at a time, as a unit quaternion.
Quaternion rotation_at(const VectorKeys& keys, double time) {
    double q[4];
    const KeyPosition at = key_position(time, keys.times);
    if (keys.interpolation != KeyInterpolation::linear || at.fraction == 0) {
        keys.at(time, q);
        return unit(q);
    }
    add_vectors(keys, at.first, {1, 0, 0, 0}, q);
    const Quaternion first = unit(q);
    add_vectors(keys, at.first + 1, {1, 0, 0, 0}, q);
    return slerp(first, unit(q), at.fraction);
}

/// Appends the times of keys (NodeMotion::times).
void add_times(const std::shared_ptr<const VectorKeys>& keys, std::vector<double>& times) {
    if (!keys) return;
    for (std::size_t k = 0; k < keys->times.size(); ++k) {
        times.push_back(keys->times[k]);
        // Fraction of the time since the last key that a jump takes.
        constexpr double kJump = 1e-6;
        if (k > 0 && keys->interpolation == KeyInterpolation::step)
            times.push_back(keys->times[k] - kJump * (keys->times[k] - keys->times[k - 1]));
    }
}

}  // namespace

void VectorKeys::at(double time, double* out) const {
    const KeyPosition at = key_position(time, times);
    const double t = at.fraction, t2 = t * t, t3 = t2 * t;
    if (interpolation != KeyInterpolation::cubic_spline)
        add_vectors(*this, at.first,
                    {interpolation == KeyInterpolation::step ? 1 : 1 - t,
                     interpolation == KeyInterpolation::step ? 0 : t, 0, 0},
                    out);
    else if (t == 0)
        add_vectors(*this, 3 * at.first + 1, {1, 0, 0, 0}, out);
    else  // Hermite polynomials of the values and tangents at both ends: value, out-tangent, in-tangent, value
        add_vectors(*this, 3 * at.first + 1,
                    {2 * t3 - 3 * t2 + 1, at.seconds * (t3 - 2 * t2 + t), at.seconds * (t3 - t2), 3 * t2 - 2 * t3},
                    out);
}

bool VectorKeys::changes() const {
    const bool is_spline = interpolation == KeyInterpolation::cubic_spline;
    for (std::size_t i = 0; i < values.size() / components; ++i)
        for (std::size_t c = 0; c < components; ++c) {
            const bool is_tangent = is_spline && i % 3 != 1;
            const float if_constant = is_tangent ? 0 : values[(is_spline ? 1 : 0) * components + c];
            if (values[i * components + c] != if_constant) return true;
        }
    return false;
}

std::string keys_error(const VectorKeys& keys, std::size_t components) {
    const std::size_t per_time = keys.interpolation == KeyInterpolation::cubic_spline ? 3 : 1;
    if (components == 0 || keys.components != components || keys.times.empty() ||
        keys.values.size() / components / per_time != keys.times.size() ||
        keys.values.size() % (components * per_time) != 0)
        return "keys must have " + std::to_string(per_time) + " times " + std::to_string(components) +
               " numbers for each time";
    for (std::size_t k = 0; k < keys.times.size(); ++k)
        if (const std::string why = key_time_error(keys.times[k], k > 0 ? &keys.times[k - 1] : nullptr); !why.empty())
            return why;
    return "";
}

Affine<double> NodeMotion::parent_from_node(double time) const {
    const Vec3d size = scale_keys ? vector_at(*scale_keys, time) : scale;
    Affine<double> map = realcam::rotation(rotation_keys ? rotation_at(*rotation_keys, time) : rotation);
    map.x = size.x * map.x;
    map.y = size.y * map.y;
    map.z = size.z * map.z;
    map.origin = translation_keys ? vector_at(*translation_keys, time) : translation;
    return map;
}

std::vector<double> NodeMotion::times() const {
    std::vector<double> times;
    for (const auto& keys : {translation_keys, rotation_keys, scale_keys}) add_times(keys, times);
    return times;
}

}  // namespace realcam
