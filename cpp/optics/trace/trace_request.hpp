#pragma once
#include <limits>

#include "../../math/vec3.hpp"
#include "lens_rays.hpp"
#include "lens_trace.hpp"

namespace REALCAM_NAMESPACE {

/// A caller's ray prepared for trace_lens.
struct LensEntry {
    Vec3d origin;  ///< relative to the same vertex as the caller's origin, mm
    Vec3d direction;  ///< optical: a unit vector times the index
    double optical_path;  ///< from the caller's origin to this one, mm
    RayStatus status;  ///< ok or bad_input; with bad_input all other members are zero
};

/// Largest coordinate of an origin, mm, a tenth of a light year; origins beyond it are bad input, because their squares
/// would overflow in float32.
inline constexpr double kFarthestOrigin = 1e18;

/// Prepares a ray for trace_lens. `origin`: relative to the vertex of the first surface in the order of the light, mm;
/// `direction`: of any length but 0; `index`: refractive index in front of that surface. Returns the status bad_input
/// if the origin is not finite or farther away than kFarthestOrigin, or if the direction is zero, infinite or NaN.
///
/// An origin farther away than `near` is moved along the ray to the point nearest to the vertex, because the quadratic
/// of the first surface would square the distance. The fused multiply-add keeps the ray on the caller's line, even from
/// the distance of a star.
REALCAM_HD inline LensEntry enter_lens(Vec3d origin, Vec3d direction, double index, double near) {
    constexpr LensEntry bad = {{0, 0, 0}, {0, 0, 0}, 0, RayStatus::bad_input};
    const auto largest_component = [](Vec3d v) {
        return std::fmax(std::fabs(v.x), std::fmax(std::fabs(v.y), std::fabs(v.z)));
    };
    const double scale = largest_component(direction);
    // The sums find NaN, which fmax ignores.
    const bool good = scale > 0 && scale <= std::numeric_limits<double>::max() &&
                      largest_component(origin) <= kFarthestOrigin &&
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

/// Rays to be traced with a PathRecord. Arrays lie in the memory of the tracing device, host or GPU.
template <class T>
struct TraceRequest {
    LensView<T> lens;
    double entry_position, exit_position;  ///< z of the vertices to which origins are relative on entry and exit, mm
    double entry_index;  ///< refractive index of the medium from which the rays enter
    double entry_reach;  ///< origins farther than this from the first vertex are moved nearer (enter_lens), mm
    std::int64_t count;  ///< number of rays
    const double *origins, *directions;  ///< count x 3, lens frame, mm; directions of any length
    double *out_origins, *out_directions;  ///< count x 3, lens frame, mm; unit directions
    double* optical_path;  ///< count; from the given origin to the last surface hit, mm
    int* status;  ///< count; RayStatus values
    int* surface_index;  ///< count; surface at which the ray ended (PathRecord); -1 for bad input
};

/// Traces the N rays from index `first` on, or those that are left at the end of the arrays. The results of a ray with
/// bad input are zero, and its surface index is -1.
template <int N, class T>
REALCAM_HD inline void trace_ray_block(const TraceRequest<T>& request, std::int64_t first) {
    LensRays<T, N> rays;
    PathRecord<T, N> record;
    double path_to_entry[N];
    const int used = static_cast<int>(request.count - first < N ? request.count - first : N);
    for (int k = 0; k < N; ++k) {
        const std::int64_t ray = first + (k < used ? k : 0);
        const double* o = request.origins + 3 * ray;
        const double* d = request.directions + 3 * ray;
        const LensEntry entry = enter_lens({o[0], o[1], o[2] - request.entry_position}, {d[0], d[1], d[2]},
                                           request.entry_index, request.entry_reach);
        rays.origin.set(k, static_cast<Vec3<T>>(entry.origin));
        rays.direction.set(k, static_cast<Vec3<T>>(entry.direction));
        rays.status[k] = static_cast<int>(entry.status);
        path_to_entry[k] = entry.optical_path;
        record.optical_path[k] = 0;
        record.surface_index[k] = -1;
    }
    trace_lens(request.lens, rays, record);
    for (int k = 0; k < used; ++k) {
        double* o = request.out_origins + 3 * (first + k);
        double* d = request.out_directions + 3 * (first + k);
        const bool bad = rays.status[k] == static_cast<int>(RayStatus::bad_input);
        const Vec3d point = static_cast<Vec3d>(rays.origin[k]);
        o[0] = bad ? 0.0 : point.x, o[1] = bad ? 0.0 : point.y, o[2] = bad ? 0.0 : point.z + request.exit_position;
        const Vec3d optical = static_cast<Vec3d>(rays.direction[k]);
        const double size = length(optical), unit = size > 0 ? 1 / size : 0.0;
        d[0] = unit * optical.x, d[1] = unit * optical.y, d[2] = unit * optical.z;
        request.optical_path[first + k] = path_to_entry[k] + static_cast<double>(record.optical_path[k]);
        request.status[first + k] = rays.status[k];
        request.surface_index[first + k] = record.surface_index[k];
    }
}

}  // namespace REALCAM_NAMESPACE
