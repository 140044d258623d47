#pragma once
#include "../../math/vec3.hpp"
#include "../trace/lens_trace.hpp"

namespace REALCAM_NAMESPACE {

/// Distribution of entry points over a rectangle.
enum class EntryPattern {
    even,  ///< two-dimensional additive sequence R2 of M. Roberts (2018): uniform for any number of rays
    grid,  ///< rectangular grid
};

/// Request for the film points of many rays of one object point (a dense spot diagram). The rays are not aimed at the
/// stop: their entry points fill a rectangle of the entry plane (see ObjectPoint), over which the light is uniform, and
/// only rays that pass the lens are recorded.
template <class T>
struct FilmPointsRequest {
    LensView<T> lens;  ///< relative to the first vertex
    Vec3<T> centre;  ///< centre of the entry plane, relative to the first vertex, mm
    Vec3<T> towards;  ///< unit vector: ray through the entry plane's centre
    Vec3<T> across, upwards;  ///< axes of the entry plane
    Vec2<T> middle, reach;  ///< the rectangle's centre, relative to the entry plane's centre, and half sides, mm
    T inverse_distance;  ///< inverse distance of the object from the entry plane's centre, 1/mm
    T index;  ///< refractive index of the medium from which the rays enter
    T film;  ///< z of the film plane relative to the last vertex, mm
    EntryPattern pattern;
    std::int64_t columns;  ///< points per row and per column of EntryPattern::grid
    std::int64_t first, count;  ///< index of the first ray of the pattern to trace, and number of rays
    float* points;  ///< result: x and y of the rays that pass, mm from the axis; must have room for `count` points
    std::int64_t passed;  ///< incremented by the number of rays that pass
};

namespace film_points_detail {

/// Computes the positions of rays `first` to `first` + N - 1 of the pattern in the rectangle; coordinates are from -1
/// to 1.
template <int N, class T>
REALCAM_HD inline void pattern_points(const FilmPointsRequest<T>& request, std::int64_t first, T (&x)[N], T (&y)[N]) {
    if (request.pattern == EntryPattern::grid) {
        const T step = T(2) / static_cast<T>(request.columns);
        for (int k = 0; k < N; ++k) {
            const std::int64_t ray = first + k;
            x[k] = (static_cast<T>(ray % request.columns) + T(0.5)) * step - T(1);
            y[k] = (static_cast<T>(ray / request.columns) + T(0.5)) * step - T(1);
        }
        return;
    }
    // Multiples of 1 / g and 1 / g^2 modulo 1, in units of 2^-32, where g is the real root of g^3 = g + 1.
    const auto from = static_cast<std::uint32_t>(first);
    REALCAM_LANES
    for (int k = 0; k < N; ++k) {
        const std::uint32_t ray = from + static_cast<std::uint32_t>(k);
        x[k] = static_cast<T>(static_cast<std::int32_t>(ray * 3242174889u)) * T(0x1p-31);
        y[k] = static_cast<T>(static_cast<std::int32_t>(ray * 2447445414u)) * T(0x1p-31);
    }
}

}  // namespace film_points_detail

/// Traces all rays of a request, N at a time, and stores the film points of those that pass. `lens_kind`: the kind of
/// the lens, or a more general one.
template <LensKind lens_kind, int N, class T>
inline void find_film_points(FilmPointsRequest<T>& request) {
    const FilmPointsRequest<T> r = request;
    LensRays<T, N> rays;
    Lanes<T, N> x, y;
    float* next_point = r.points;
    for (std::int64_t traced = 0; traced < r.count; traced += N) {
        const int used_lanes = static_cast<int>(r.count - traced < N ? r.count - traced : N);
        film_points_detail::pattern_points<N>(r, r.first + traced, x, y);
        REALCAM_LANES
        for (int k = 0; k < N; ++k) {
            const T right = r.middle.x + r.reach.x * x[k], up = r.middle.y + r.reach.y * y[k];
            const Vec3<T> offset = right * r.across + up * r.upwards;
            const Vec3<T> direction = r.towards + r.inverse_distance * offset;
            const T scale =
                r.index / std::sqrt(direction.x * direction.x + direction.y * direction.y + direction.z * direction.z);
            rays.origin.set(k, r.centre + offset);
            rays.direction.set(k, scale * direction);
            rays.status[k] = 0;
        }
        trace_lens<lens_kind>(r.lens, rays);
        REALCAM_LANES
        for (int k = 0; k < N; ++k) {
            const Vec2<T> at = crossing_at(r.film, rays.origin[k], rays.direction[k]);
            x[k] = at.x;
            y[k] = at.y;
        }
        for (int k = 0; k < used_lanes; ++k) {
            next_point[0] = static_cast<float>(x[k]);
            next_point[1] = static_cast<float>(y[k]);
            next_point += 2 * static_cast<std::int64_t>(rays.status[k] == 0);
        }
    }
    request.passed += (next_point - r.points) / 2;
}

}  // namespace REALCAM_NAMESPACE
