#pragma once
#include <algorithm>
#include <cmath>

#include "affine.hpp"

// Interpolation of transforms for animation: rotations along great arcs, stretch and translation linearly.

namespace REALCAM_NAMESPACE {

/// Quaternion with vector part `v` and scalar part `w`; of unit length if it is a rotation. The default is the
/// identity.
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

/// Returns the rotation of a quaternion, which may have any length but 0.
inline Affine<double> rotation(Quaternion q) {
    q = (1 / std::sqrt(dot(q, q))) * q;
    const auto [x, y, z] = q.v;
    const double w = q.w;
    return {{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
            {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
            {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)},
            {0, 0, 0}};
}

/// Returns the unit quaternion of a rotation; its translation is ignored. The formula divides by the largest of the
/// four components, which avoids cancellation (Shepperd 1978).
inline Quaternion quaternion_of(const Affine<double>& r) {
    const double trace = r.x.x + r.y.y + r.z.z;
    const double largest = std::max({trace, r.x.x, r.y.y, r.z.z});
    Quaternion q;
    if (largest == trace)
        q = {{r.y.z - r.z.y, r.z.x - r.x.z, r.x.y - r.y.x}, 1 + trace};
    else if (largest == r.x.x)
        q = {{1 + 2 * r.x.x - trace, r.x.y + r.y.x, r.z.x + r.x.z}, r.y.z - r.z.y};
    else if (largest == r.y.y)
        q = {{r.x.y + r.y.x, 1 + 2 * r.y.y - trace, r.y.z + r.z.y}, r.z.x - r.x.z};
    else
        q = {{r.z.x + r.x.z, r.y.z + r.z.y, 1 + 2 * r.z.z - trace}, r.x.y - r.y.x};
    return (1 / std::sqrt(dot(q, q))) * q;
}

/// Spherical linear interpolation between two unit quaternions along the shorter arc, from a (t = 0) to b (t = 1)
/// (Shoemake 1985).
inline Quaternion slerp(const Quaternion& a, Quaternion b, double t) {
    if (dot(a, b) < 0) b = -1.0 * b;
    // Angle between the unit vectors. The arc cosine of their dot product would lose half of the digits of a small
    // angle.
    const Quaternion difference = b + -1.0 * a, sum = a + b;
    const double angle = 2 * std::atan2(std::sqrt(dot(difference, difference)), std::sqrt(dot(sum, sum)));
    if (!(angle > 1e-9)) return (1 - t) * a + t * b;
    return (std::sin((1 - t) * angle) / std::sin(angle)) * a + (std::sin(t * angle) / std::sin(angle)) * b;
}

/// Polar decomposition of the linear part of a map: rotation * stretch. The stretch is symmetric, and negated if the
/// map mirrors.
struct PolarDecomposition {
    Quaternion rotation;
    Affine<double> stretch;
};

/// Returns the polar decomposition of a map whose determinant is not 0, by the scaled Newton iteration of N. J. Higham
/// (1986).
inline PolarDecomposition polar_decomposition(const Affine<double>& map) {
    Affine<double> r = {map.x, map.y, map.z, {0, 0, 0}};
    if (map.determinant() < 0) r = {-map.x, -map.y, -map.z, {0, 0, 0}};
    for (int i = 0; i < 64; ++i) {
        const double inverse_determinant = 1 / r.determinant();
        const Affine<double> inverse_transpose = {inverse_determinant * cross(r.y, r.z),
                                                  inverse_determinant * cross(r.z, r.x),
                                                  inverse_determinant * cross(r.x, r.y),
                                                  {0, 0, 0}};
        const auto squared_norm = [](const Affine<double>& m) { return dot(m.x, m.x) + dot(m.y, m.y) + dot(m.z, m.z); };
        const double scale = std::sqrt(std::sqrt(squared_norm(inverse_transpose) / squared_norm(r)));
        const Affine<double> previous = r;
        r.x = 0.5 * (scale * r.x + (1 / scale) * inverse_transpose.x);
        r.y = 0.5 * (scale * r.y + (1 / scale) * inverse_transpose.y);
        r.z = 0.5 * (scale * r.z + (1 / scale) * inverse_transpose.z);
        const Affine<double> step = {r.x - previous.x, r.y - previous.y, r.z - previous.z, {0, 0, 0}};
        if (squared_norm(step) < 1e-30) break;
    }
    const Quaternion q = quaternion_of(r);
    const Affine<double> inverse_rotation = rotation({-q.v, q.w});
    return {q,
            {inverse_rotation.direction(map.x),
             inverse_rotation.direction(map.y),
             inverse_rotation.direction(map.z),
             {0, 0, 0}}};
}

/// Interpolates from map a (t = 0) to map b (t = 1), which must both mirror or both not: rotations along the shorter
/// arc at constant speed, stretch and translation linearly (Shoemake and Duff 1992). Determinants must not be 0.
inline Affine<double> interpolated(const Affine<double>& a, const Affine<double>& b, double t) {
    const Vec3d origin = mix(a.origin, b.origin, t);
    if (a.x == b.x && a.y == b.y && a.z == b.z) return {a.x, a.y, a.z, origin};
    const PolarDecomposition from = polar_decomposition(a), to = polar_decomposition(b);
    Affine<double> map = rotation(slerp(from.rotation, to.rotation, t)) * mix(from.stretch, to.stretch, t);
    map.origin = origin;
    return map;
}

}  // namespace REALCAM_NAMESPACE
