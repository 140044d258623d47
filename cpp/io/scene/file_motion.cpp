#include "file_motion.hpp"

#include <array>
#include <cmath>

namespace realcam::io {
namespace {

using Components = std::array<double, 4>;

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

/// Returns the vector of this index in FileKeys::values.
Components vector_of(const FileKeys& keys, std::size_t index) {
    Components out{};
    for (std::size_t c = 0; c < keys.components; ++c)
        out[c] = static_cast<double>(keys.values[index * keys.components + c]);
    return out;
}

/// Interpolates by Hermite polynomials, from the values p0, p1 and tangents m0, m1 at both ends.
Components on_spline(const FileKeys& keys, const KeyPosition& at) {
    const Components p0 = vector_of(keys, 3 * at.first + 1);
    if (at.fraction == 0) return p0;
    const Components m0 = vector_of(keys, 3 * at.first + 2), m1 = vector_of(keys, 3 * at.first + 3),
                     p1 = vector_of(keys, 3 * at.first + 4);
    const double t = at.fraction, t2 = t * t, t3 = t2 * t;
    Components out{};
    for (std::size_t c = 0; c < keys.components; ++c)
        out[c] = (2 * t3 - 3 * t2 + 1) * p0[c] + at.seconds * (t3 - 2 * t2 + t) * m0[c] + (3 * t2 - 2 * t3) * p1[c] +
                 at.seconds * (t3 - t2) * m1[c];
    return out;
}

/// Returns a translation or scale at a time.
Vec3d vector_at(const FileKeys& keys, double time) {
    const KeyPosition at = key_position(time, keys.times);
    const auto to_vec3 = [](const Components& c) { return Vec3d{c[0], c[1], c[2]}; };
    if (keys.interpolation == KeyInterpolation::cubic_spline) return to_vec3(on_spline(keys, at));
    const Vec3d first = to_vec3(vector_of(keys, at.first));
    if (at.fraction == 0 || keys.interpolation == KeyInterpolation::step) return first;
    return (1 - at.fraction) * first + at.fraction * to_vec3(vector_of(keys, at.first + 1));
}

/// Returns a rotation at a time, as a unit quaternion.
Quaternion rotation_at(const FileKeys& keys, double time) {
    const KeyPosition at = key_position(time, keys.times);
    const auto unit = [](const Components& c) {
        const Quaternion q = {{c[0], c[1], c[2]}, c[3]};
        const double size = std::sqrt(dot(q, q));
        return size > 0 ? (1 / size) * q : Quaternion{};
    };
    if (keys.interpolation == KeyInterpolation::cubic_spline) return unit(on_spline(keys, at));
    const Quaternion first = unit(vector_of(keys, at.first));
    if (at.fraction == 0 || keys.interpolation == KeyInterpolation::step) return first;
    return slerp(first, unit(vector_of(keys, at.first + 1)), at.fraction);
}

/// Appends the times of keys (FileMotion::times).
void add_times(const std::shared_ptr<const FileKeys>& keys, std::vector<double>& times) {
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

Affine<double> FileMotion::parent_from_node(double time) const {
    const Vec3d size = scale_keys ? vector_at(*scale_keys, time) : scale;
    Affine<double> map = realcam::rotation(rotation_keys ? rotation_at(*rotation_keys, time) : rotation);
    map.x = size.x * map.x;
    map.y = size.y * map.y;
    map.z = size.z * map.z;
    map.origin = translation_keys ? vector_at(*translation_keys, time) : translation;
    return map;
}

std::vector<double> FileMotion::times() const {
    std::vector<double> times;
    for (const auto& keys : {translation_keys, rotation_keys, scale_keys}) add_times(keys, times);
    return times;
}

}  // namespace realcam::io
