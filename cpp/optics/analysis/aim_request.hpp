#pragma once
#include <cmath>
#include <cstdint>

#include "../../math/vec3.hpp"
#include "../trace/lens_trace.hpp"

namespace REALCAM_NAMESPACE {

/// A ray of one object point, aimed at a point on the stop and traced through the lens.
struct AimedRay {
    RayStatus status;  ///< no_convergence: no ray through this point was found
    Vec2<double> entry;  ///< intersection with the entry plane (ObjectPoint::Entry), mm; NaN if there is no ray
    Vec3d origin;  ///< on the last surface hit, relative to the last vertex
    Vec3d direction;  ///< optical: unit vector times the index behind the lens
    double path;  ///< optical path to `origin`, mm, less that from the object to the entry plane's centre
};

/// Approximate map from the stop to the entry plane for the rays of one object point. Each coordinate is a polynomial
/// in x and y on the stop, in units of `reach`. Terms x^i y^j are ordered by i, then by j.
struct StopMap {
    static constexpr int kDegree = 10, kTerms = (kDegree + 1) * (kDegree + 2) / 2;
    double reach;  ///< radius inside which the polynomials hold, mm
    double x[kTerms], y[kTerms];
};

/// Rays to be aimed together at points on the stop. Lens views and positions are relative to the first vertex.
struct AimRequest {
    LensView<double> to_stop;  ///< without rims, up to the stop
    LensView<double> lens;  ///< with rims
    Vec3d centre;  ///< centre of the entry plane, relative to the first vertex, mm
    Vec3d towards;  ///< unit vector: ray through the entry plane's centre
    Vec3d across, upwards;  ///< axes of the entry plane
    double inverse_distance;  ///< inverse distance of the object from the entry plane's centre, 1/mm
    double index;  ///< refractive index of the medium from which the rays enter
    double miss;  ///< tolerance of a ray's point on the stop, mm
    const StopMap* map;
    std::int64_t count;
    const Vec2<double>* targets;  ///< target points on the stop, mm
    AimedRay* rays;
};

namespace aim_detail {

/// Horner's scheme for c[0] + c[1] u + ... of `count` terms. Recursive, because gcc does not unroll nested loops if the
/// inner one's length depends on the outer index, and then does not vectorise over the lanes.
template <int count>
REALCAM_INLINE double horner(const double* c, double u) {
    if constexpr (count == 1)
        return c[0];
    else
        return c[0] + u * horner<count - 1>(c + 1, u);
}

/// The terms of a StopMap from x^i on, divided by x^i.
template <int i = 0>
REALCAM_INLINE double map_terms(const double* c, double x, double y) {
    constexpr int kRow = StopMap::kDegree + 1 - i;
    if constexpr (kRow == 1)
        return c[0];
    else
        return horner<kRow>(c, y) + x * map_terms<i + 1>(c + kRow, x, y);
}

template <int N>
REALCAM_HD inline void entries_at(const StopMap& map, const Vec2Lanes<double, N>& targets,
                                  Vec2Lanes<double, N>& entries) {
    const double unit = 1 / map.reach;
    REALCAM_LANES
    for (int k = 0; k < N; ++k) {
        const double x = unit * targets.x[k], y = unit * targets.y[k];
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
        const Vec3d direction = request.towards + request.inverse_distance * offset;
        const double scale = request.index / std::sqrt(direction.x * direction.x + direction.y * direction.y +
                                                       direction.z * direction.z);
        rays.origin.set(k, request.centre + offset);
        rays.direction.set(k, scale * direction);
        rays.status[k] = 0;
    }
}

}  // namespace aim_detail

/// Aims the rays of a request, N at a time, and traces them through the lens.
///
/// Each iteration moves the argument of the map by the distance by which its ray misses its target. This reduces the
/// miss by a factor equal to the relative error of the map's slopes, about a millionth; no derivatives are needed. A
/// ray that is not within tolerance after a few iterations, and one whose target lies outside the map's reach, has the
/// status no_convergence.
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
        for (int k = 0; k < N; ++k) wanted.set(k, r.targets[first + (k < used ? k : 0)]);
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
            const Vec2<double> target = wanted[k], entry = entries[k];
            const bool inside = target.x * target.x + target.y * target.y <= r.map->reach * r.map->reach;
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
