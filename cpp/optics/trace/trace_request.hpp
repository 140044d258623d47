#pragma once
#include "lens_entry.hpp"
#include "lens_trace.hpp"

namespace REALCAM_NAMESPACE {

/// Rays to be traced with a PathRecord. Arrays lie in the memory of the tracing device, host or GPU.
template <class T>
struct TraceRequest {
    LensView<T> lens;
    double entry_position, exit_position;  ///< z of the vertices to which origins are relative on entry and exit, mm
    double entry_index;  ///< of the medium from which the rays enter
    double entry_reach;  ///< origins farther than this from the first vertex are moved nearer (enter_lens), mm
    std::int64_t count;
    const double *origins, *directions;  ///< count x 3, lens frame, mm; directions of any length
    double *out_origins, *out_directions;  ///< count x 3, lens frame, mm; unit directions
    double* optical_path;  ///< count, mm
    int *status, *surface_index;  ///< count; see PathRecord
};

/// Traces N rays, starting at index `first`; fewer at the end of the arrays.
template <int N, class T>
REALCAM_HD inline void trace_rays_of(const TraceRequest<T>& request, std::int64_t first) {
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
        const Vec3d at = static_cast<Vec3d>(rays.origin[k]);
        o[0] = bad ? 0.0 : at.x, o[1] = bad ? 0.0 : at.y, o[2] = bad ? 0.0 : at.z + request.exit_position;
        const Vec3d optical = static_cast<Vec3d>(rays.direction[k]);
        const double size = length(optical), unit = size > 0 ? 1 / size : 0.0;
        d[0] = unit * optical.x, d[1] = unit * optical.y, d[2] = unit * optical.z;
        request.optical_path[first + k] = path_to_entry[k] + static_cast<double>(record.optical_path[k]);
        request.status[first + k] = rays.status[k];
        request.surface_index[first + k] = record.surface_index[k];
    }
}

}  // namespace REALCAM_NAMESPACE
