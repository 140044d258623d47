#pragma once
#include "quaternion.hpp"

namespace REALCAM_NAMESPACE {

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
