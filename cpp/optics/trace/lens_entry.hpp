#pragma once
#include <limits>

#include "../../math/vec3.hpp"
#include "ray_status.hpp"

namespace REALCAM_NAMESPACE {

/// A caller's ray prepared for trace_lens.
struct LensEntry {
    Vec3d origin;          ///< relative to the same vertex as the caller's origin, mm
    Vec3d direction;       ///< optical: a unit vector times the index
    double optical_path;   ///< from the caller's origin to this one, mm
    RayStatus status;      ///< ok or bad_input; with bad_input all other members are zero
};

/// Largest coordinate of an origin, mm; beyond it, squares would overflow in float32. A tenth of a light year.
inline constexpr double kFarthestOrigin = 1e18;

/// Accepts any origin and a direction of any length, relative to the vertex of the first surface in the order of the
/// light.
///
/// An origin farther away than `near` is moved along the ray to the point nearest to the vertex, because the quadratic
/// of the first surface would square the distance. The fused multiply-add keeps the ray on the caller's line, even from
/// the distance of a star.
REALCAM_HD inline LensEntry enter_lens(Vec3d origin, Vec3d direction, double index, double near) {
    constexpr LensEntry bad = {{0, 0, 0}, {0, 0, 0}, 0, RayStatus::bad_input};
    const auto largest = [](Vec3d v) { return std::fmax(std::fabs(v.x), std::fmax(std::fabs(v.y), std::fabs(v.z))); };
    const double scale = largest(direction);
    // The sums find NaN, which fmax ignores.
    const bool good = scale > 0 && scale <= std::numeric_limits<double>::max() && largest(origin) <= kFarthestOrigin &&
                      !std::isnan(direction.x + direction.y + direction.z) && !std::isnan(dot(origin, {1, 1, 1}));
    if (!good) return bad;
    // Squares of extremely long or short vectors leave the range of double: these vectors are first scaled to the order
    // of 1, by a power of two, which is exact. All others skip these calls, which would take half of the time that a
    // ray needs to enter and leave.
    Vec3d d = direction;
    if (!(scale > 0x1p-400 && scale < 0x1p400)) {
        const int order = -std::ilogb(scale);
        d = {std::scalbn(direction.x, order), std::scalbn(direction.y, order), std::scalbn(direction.z, order)};
    }
    const double size = length(d);
    if (!(dot(origin, origin) > near * near)) return {origin, (index / size) * d, 0, RayStatus::ok};
    const double t = -dot(origin, d) / dot(d, d);
    const Vec3d nearest = {std::fma(t, d.x, origin.x), std::fma(t, d.y, origin.y), std::fma(t, d.z, origin.z)};
    return {nearest, (index / size) * d, index * size * t, RayStatus::ok};
}

}  // namespace REALCAM_NAMESPACE
