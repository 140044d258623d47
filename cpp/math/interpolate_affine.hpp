#pragma once
#include <algorithm>
#include <cmath>

#include "affine.hpp"

namespace REALCAM_NAMESPACE {

/// A rotation, as a unit quaternion v + w.
struct Quaternion {
    Vec3d v = {0, 0, 0};
    double w = 1;
};

inline Quaternion operator*(double s, const Quaternion& q) {
    return {s * q.v, s * q.w};
}
inline Quaternion operator+(const Quaternion& a, const Quaternion& b) {
    return {a.v + b.v, a.w + b.w};
}
inline double dot(const Quaternion& a, const Quaternion& b) {
    return dot(a.v, b.v) + a.w * b.w;
}

/// Returns the rotation of a non-zero quaternion of any length.
inline Affine<double> rotation(Quaternion q) {
    q = (1 / std::sqrt(dot(q, q))) * q;
    const auto [x, y, z] = q.v;
    const double w = q.w;
    return {{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
            {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
            {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)},
            {0, 0, 0}};
}

/// Returns the quaternion of the linear part of a rotation. It starts from the largest of the four components, which
/// loses no digits (Shepperd 1978).
inline Quaternion quaternion_of(const Affine<double>& r) {
    const double trace = r.x.x + r.y.y + r.z.z;
    const double most = std::max({trace, r.x.x, r.y.y, r.z.z});
    Quaternion q;
    if (most == trace)
        q = {{r.y.z - r.z.y, r.z.x - r.x.z, r.x.y - r.y.x}, 1 + trace};
    else if (most == r.x.x)
        q = {{1 + 2 * r.x.x - trace, r.x.y + r.y.x, r.z.x + r.x.z}, r.y.z - r.z.y};
    else if (most == r.y.y)
        q = {{r.x.y + r.y.x, 1 + 2 * r.y.y - trace, r.y.z + r.z.y}, r.z.x - r.x.z};
    else
        q = {{r.z.x + r.x.z, r.y.z + r.z.y, 1 + 2 * r.z.z - trace}, r.x.y - r.y.x};
    return (1 / std::sqrt(dot(q, q))) * q;
}

/// Interpolates between two rotations along the shorter arc, at a fraction of the angle between them (Shoemake 1985).
inline Quaternion slerp(const Quaternion& a, Quaternion b, double share) {
    if (dot(a, b) < 0) b = -1.0 * b;
    // The angle between unit vectors; the arc cosine would lose half of the digits of a small angle.
    const Quaternion apart = b + -1.0 * a, sum = a + b;
    const double angle = 2 * std::atan2(std::sqrt(dot(apart, apart)), std::sqrt(dot(sum, sum)));
    if (!(angle > 1e-9)) return (1 - share) * a + share * b;
    return (std::sin((1 - share) * angle) / std::sin(angle)) * a + (std::sin(share * angle) / std::sin(angle)) * b;
}

/// Polar decomposition of a map's linear part: a rotation applied after a stretch along three axes (with a reflection,
/// if the map mirrors).
struct PolarDecomposition {
    Quaternion rotation;
    Affine<double> stretch;
};

/// Returns the polar decomposition of a map whose determinant is not 0, by Newton's iteration with scaling (Higham
/// 1986).
inline PolarDecomposition polar_decomposition(const Affine<double>& map) {
    Affine<double> r = {map.x, map.y, map.z, {0, 0, 0}};
    if (map.determinant() < 0) r = {-map.x, -map.y, -map.z, {0, 0, 0}};
    for (int i = 0; i < 64; ++i) {
        const double inverse = 1 / r.determinant();
        const Affine<double> back = {inverse * cross(r.y, r.z),
                                     inverse * cross(r.z, r.x),
                                     inverse * cross(r.x, r.y),
                                     {0, 0, 0}};  // the inverse, transposed
        const auto size = [](const Affine<double>& m) { return dot(m.x, m.x) + dot(m.y, m.y) + dot(m.z, m.z); };
        const double scale = std::sqrt(std::sqrt(size(back) / size(r)));
        const Affine<double> last = r;
        r.x = 0.5 * (scale * r.x + (1 / scale) * back.x);
        r.y = 0.5 * (scale * r.y + (1 / scale) * back.y);
        r.z = 0.5 * (scale * r.z + (1 / scale) * back.z);
        const Affine<double> step = {r.x - last.x, r.y - last.y, r.z - last.z, {0, 0, 0}};
        if (size(step) < 1e-30) break;
    }
    const Quaternion q = quaternion_of(r);
    const Affine<double> turned = rotation({-q.v, q.w});
    return {q, {turned.direction(map.x), turned.direction(map.y), turned.direction(map.z), {0, 0, 0}}};
}

/// Interpolates between two maps, which mirror both or neither: rotations along the shorter arc at constant speed,
/// stretch and translation linearly (Shoemake and Duff 1992). `share` 0 gives a, and 1 gives b.
inline Affine<double> interpolated(const Affine<double>& a, const Affine<double>& b, double share) {
    const Vec3d origin = mix(a.origin, b.origin, share);
    if (a.x == b.x && a.y == b.y && a.z == b.z) return {a.x, a.y, a.z, origin};
    const PolarDecomposition from = polar_decomposition(a), to = polar_decomposition(b);
    Affine<double> map = rotation(slerp(from.rotation, to.rotation, share)) * mix(from.stretch, to.stretch, share);
    map.origin = origin;
    return map;
}

}  // namespace REALCAM_NAMESPACE
