#pragma once
#include <cmath>
#include <cstdint>

#include "../../math/vec3.hpp"
#include "../trace/lens_trace.hpp"

namespace REALCAM_NAMESPACE {

/// A ray of one object point that was aimed at a place on the stop, behind the lens.
struct AimedRay {
    RayStatus status;  ///< no_convergence: no ray was found that meets this place
    Vec2<double> entry;  ///< where it crosses the entry plane (ObjectPoint::Entry), mm; NaN where there is no ray
    Vec3d origin;  ///< on the last surface met, relative to the last vertex
    Vec3d direction;  ///< optical: unit times the index behind the lens
    double path;  ///< optical path up to there, mm, less that from the object to the middle of the entry plane
};

/// An approximation of where the rays of one object point cross the entry plane, by their places on the stop. Each
/// coordinate is a polynomial in x and y, shares of `reach`. Its terms x^i y^j are in the order of i, and of j.
struct StopMap {
    static constexpr int kDegree = 10, kTerms = (kDegree + 1) * (kDegree + 2) / 2;
    double reach;  ///< radius inside which the polynomials hold, mm
    double x[kTerms], y[kTerms];
};

/// Rays to be aimed together at places on the stop. Lenses as LensView has them, relative to the first vertex.
struct AimRequest {
    LensView<double> to_stop;  ///< without rims, up to the stop
    LensView<double> lens;     ///< as it is
    Vec3d centre;              ///< of the entry plane, relative to the first vertex, mm
    Vec3d towards;             ///< unit: of the ray through the entry plane's middle
    Vec3d across, upwards;     ///< the axes of the entry plane
    double inverse_distance;   ///< of the object from the entry plane's middle, 1/mm
    double index;              ///< of the medium from which the rays enter
    double miss;               ///< how far from its place a ray may meet the stop, mm
    const StopMap* map;
    std::int64_t count;
    const Vec2<double>* places;  ///< mm
    AimedRay* rays;
};

namespace aim_detail {

/// c[0] + c[1] u + ... of `count` terms. By recursion, because gcc does not unroll two nested loops of which one is as
/// long as the other says, and so would not make vector code of the lanes.
template <int count>
REALCAM_INLINE double horner(const double* c, double u) {
    if constexpr (count == 1)
        return c[0];
    else
        return c[0] + u * horner<count - 1>(c + 1, u);
}

/// The terms of a StopMap from x^i on, over x^i.
template <int i = 0>
REALCAM_INLINE double map_terms(const double* c, double x, double y) {
    constexpr int kRow = StopMap::kDegree + 1 - i;
    if constexpr (kRow == 1)
        return c[0];
    else
        return horner<kRow>(c, y) + x * map_terms<i + 1>(c + kRow, x, y);
}

template <int N>
REALCAM_HD inline void entries_at(const StopMap& map, const Vec2Lanes<double, N>& places,
                                  Vec2Lanes<double, N>& entries) {
    const double unit = 1 / map.reach;
    REALCAM_LANES
    for (int k = 0; k < N; ++k) {
        const double x = unit * places.x[k], y = unit * places.y[k];
        entries.x[k] = map_terms(map.x, x, y);
        entries.y[k] = map_terms(map.y, x, y);
    }
}

template <int N>
REALCAM_HD inline void start_rays(const AimRequest& request, const Vec2Lanes<double, N>& entries,
                                  LensRays<double, N>& rays) {
    REALCAM_LANES
    for (int k = 0; k < N; ++k) {
        const Vec3d offset = entries.x[k] * request.across + entries.y[k] * request.upwards;
        const Vec3d way = request.towards + request.inverse_distance * offset;
        const double scale = request.index / std::sqrt(way.x * way.x + way.y * way.y + way.z * way.z);
        rays.origin.set(k, request.centre + offset);
        rays.direction.set(k, scale * way);
        rays.status[k] = 0;
    }
}

}  // namespace aim_detail

/// Aims the rays of a request, N at a time, and traces them through the lens. The place at which the map is evaluated
/// is moved by the distance by which the map's ray misses its place. Each such step leaves a share of the miss that is
/// the error of the map's slopes, about a millionth. It needs no derivatives. A ray that has not come near enough after
/// a few steps, and one whose place lies beyond the map's, has the status no_convergence.
template <int N>
REALCAM_HD inline void aim_rays(const AimRequest& request) {
    using namespace aim_detail;
    constexpr int kMostSteps = 6;
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    const AimRequest r = request;
    Vec2Lanes<double, N> wanted{}, asked{}, entries{};
    LensRays<double, N> rays;
    PathRecord<double, N> record;
    Lanes<double, N> missed;
    for (std::int64_t first = 0; first < r.count; first += N) {
        const int used = static_cast<int>(r.count - first < N ? r.count - first : N);
        for (int k = 0; k < N; ++k) wanted.set(k, r.places[first + (k < used ? k : 0)]);
        asked = wanted;
        for (int step = 0; step < kMostSteps; ++step) {
            entries_at(*r.map, asked, entries);
            start_rays(r, entries, rays);
            trace_lens(r.to_stop, rays);
            int searching = 0;
            REALCAM_LANES
            for (int k = 0; k < N; ++k) {
                const double dx = wanted.x[k] - rays.origin.x[k], dy = wanted.y[k] - rays.origin.y[k];
                const double square = select(rays.status[k] == 0, dx * dx + dy * dy, nan);
                const bool misses = square > r.miss * r.miss;
                missed[k] = square;
                asked.x[k] += select(misses, dx, 0.0);
                asked.y[k] += select(misses, dy, 0.0);
                searching |= static_cast<int>(misses);
            }
            if (searching == 0) break;
        }
        start_rays(r, entries, rays);
        for (int k = 0; k < N; ++k) {
            record.optical_path[k] = 0;
            record.surface_index[k] = -1;
        }
        trace_lens(r.lens, rays, record);
        for (int k = 0; k < used; ++k) {
            const Vec2<double> place = wanted[k], entry = entries[k];
            const bool inside = place.x * place.x + place.y * place.y <= r.map->reach * r.map->reach;
            AimedRay& ray = r.rays[first + k];
            if (!inside || !(missed[k] <= r.miss * r.miss)) {
                ray = {RayStatus::no_convergence, {nan, nan}, {nan, nan, nan}, {nan, nan, nan}, nan};
                continue;
            }
            const double square = entry.x * entry.x + entry.y * entry.y, d = r.inverse_distance;
            ray = {static_cast<RayStatus>(rays.status[k]), entry, rays.origin[k], rays.direction[k],
                   record.optical_path[k] + r.index * square * d / (1 + std::sqrt(1 + square * d * d))};
        }
    }
}

}  // namespace REALCAM_NAMESPACE
