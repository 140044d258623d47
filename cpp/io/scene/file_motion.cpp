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
    double share, seconds;
};

KeyPosition key_position(double time, const std::vector<double>& times) {
    const auto next = std::upper_bound(times.begin(), times.end(), time);
    if (next == times.begin()) return {0, 0, 0};
    const auto first = static_cast<std::size_t>(next - times.begin()) - 1;
    if (next == times.end()) return {first, 0, 0};
    const double seconds = *next - times[first];
    return {first, (time - times[first]) / seconds, seconds};
}

Components read(const FileKeys& keys, std::size_t row) {
    Components out{};
    for (std::size_t c = 0; c < keys.components; ++c)
        out[c] = static_cast<double>(keys.values[row * keys.components + c]);
    return out;
}

/// Interpolates by Hermite polynomials, from the values and tangents at both ends.
Components on_spline(const FileKeys& keys, const KeyPosition& at) {
    const Components p0 = read(keys, 3 * at.first + 1);
    if (at.share == 0) return p0;
    const Components m0 = read(keys, 3 * at.first + 2), m1 = read(keys, 3 * at.first + 3),
                     p1 = read(keys, 3 * at.first + 4);
    const double t = at.share, t2 = t * t, t3 = t2 * t;
    Components out{};
    for (std::size_t c = 0; c < keys.components; ++c)
        out[c] = (2 * t3 - 3 * t2 + 1) * p0[c] + at.seconds * (t3 - 2 * t2 + t) * m0[c] + (3 * t2 - 2 * t3) * p1[c] +
                 at.seconds * (t3 - t2) * m1[c];
    return out;
}

Vec3d vector_at(const FileKeys& keys, double time) {
    const KeyPosition at = key_position(time, keys.times);
    const auto vector = [](const Components& c) { return Vec3d{c[0], c[1], c[2]}; };
    if (keys.interpolation == KeyInterpolation::cubic_spline) return vector(on_spline(keys, at));
    const Vec3d first = vector(read(keys, at.first));
    if (at.share == 0 || keys.interpolation == KeyInterpolation::step) return first;
    return (1 - at.share) * first + at.share * vector(read(keys, at.first + 1));
}

Quaternion rotation_at(const FileKeys& keys, double time) {
    const KeyPosition at = key_position(time, keys.times);
    const auto unit = [](const Components& c) {
        const Quaternion q = {{c[0], c[1], c[2]}, c[3]};
        const double size = std::sqrt(dot(q, q));
        return size > 0 ? (1 / size) * q : Quaternion{};
    };
    if (keys.interpolation == KeyInterpolation::cubic_spline) return unit(on_spline(keys, at));
    const Quaternion first = unit(read(keys, at.first));
    if (at.share == 0 || keys.interpolation == KeyInterpolation::step) return first;
    return slerp(first, unit(read(keys, at.first + 1)), at.share);
}

void add_times(const std::shared_ptr<const FileKeys>& keys, std::vector<double>& times) {
    if (!keys) return;
    for (std::size_t k = 0; k < keys->times.size(); ++k) {
        times.push_back(keys->times[k]);
        // A jump takes a millionth of the time since the last key.
        if (k > 0 && keys->interpolation == KeyInterpolation::step)
            times.push_back(keys->times[k] - 1e-6 * (keys->times[k] - keys->times[k - 1]));
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
