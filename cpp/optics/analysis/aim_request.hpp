#pragma once
#include <cmath>
#include <cstdint>

#include "../../math/vec3.hpp"
#include "../trace/lens_trace.hpp"

// Aiming of rays at points on the stop, as vector code.

namespace REALCAM_NAMESPACE {

/// A ray of one object point, aimed at a point on the stop and traced through the lens.
struct AimedRay {
    RayStatus status;  ///< no_convergence: no ray through this point was found
    Vec2<double> entry;  ///< intersection with the entry plane (ObjectPoint::Entry), mm; NaN if no ray was found
    Vec3d origin;  ///< point on the last surface hit, mm, relative to the last vertex
    Vec3d direction;  ///< optical direction: unit vector times the refractive index behind the lens
    /// Optical path from the object to `origin` minus that from the object to the entry plane's centre, mm.
    double path;
};

/// Approximate map from points on the stop to the entry points of the rays of one object point that pass through them.
/// Each coordinate of the entry point is a polynomial in x and y on the stop, in units of `reach`. The terms x^i y^j
/// with i + j <= kDegree are ordered by i, then by j.
struct StopMap {
    static constexpr int kDegree = 10;  ///< largest i + j
    static constexpr int kTerms = (kDegree + 1) * (kDegree + 2) / 2;
    double reach;  ///< radius on the stop inside which the polynomials are valid, mm
    double x[kTerms], y[kTerms];  ///< coefficients of the entry point's coordinates, mm
};

/// Rays of one object point to be aimed together at points on the stop. Lens views and positions are relative to the
/// first vertex. See ObjectPoint for the entry plane.
struct AimRequest {
    LensView<double> to_stop;  ///< surfaces up to the stop, without rims
    LensView<double> lens;  ///< all surfaces, with rims
    Vec3d centre;  ///< centre of the entry plane, relative to the first vertex, mm
    Vec3d towards;  ///< unit vector: ray through the entry plane's centre
    Vec3d across, upwards;  ///< axes of the entry plane
    double inverse_distance;  ///< inverse distance of the object from the entry plane's centre, 1/mm
    double index;  ///< refractive index of the medium from which the rays enter
    double miss;  ///< largest accepted distance of a ray from its target on the stop, mm
    const StopMap* map;
    std::int64_t count;  ///< number of rays
    const Vec2<double>* targets;  ///< target points on the stop, mm, one per ray
    AimedRay* rays;  ///< results, one per target
};

namespace aim_detail {

/// Evaluates the polynomial c[0] + c[1] u + ... with `count` terms by Horner's scheme. It is recursive, because gcc
/// does not unroll nested loops if the length of the inner one depends on the outer index, and then does not vectorise
/// over the lanes.
template <int count>
REALCAM_INLINE double horner(const double* c, double u) {
    if constexpr (count == 1)
        return c[0];
    else
        return c[0] + u * horner<count - 1>(c + 1, u);
}

/// Evaluates the terms of a StopMap that contain x^i, divided by x^i. `c`: coefficients, from the first such term on.
template <int i = 0>
REALCAM_INLINE double map_terms(const double* c, double x, double y) {
    constexpr int kRowTerms = StopMap::kDegree + 1 - i;
    if constexpr (kRowTerms == 1)
        return c[0];
    else
        return horner<kRowTerms>(c, y) + x * map_terms<i + 1>(c + kRowTerms, x, y);
}

/// Evaluates the map: entry points for N points on the stop (mm).
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

/// Starts N rays of the object point at their entry points.
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
/// The map yields an entry point for an argument near the target. Each iteration moves the argument by the vector by
/// which the ray misses its target. This reduces the miss by a factor equal to the relative error of the map's slopes,
/// about a millionth, and needs no derivatives. A ray that is not within tolerance after a few iterations, or whose
/// target lies outside the map's reach, gets the status no_convergence.
template <int N>
REALCAM_HD inline void aim_rays(const AimRequest& request) {
    using namespace aim_detail;
    constexpr int kMaxSteps = 6;
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    const AimRequest r = request;
    Vec2Lanes<double, N> targets{}, arguments{}, entries{};
    LensRays<double, N> rays;
    PathRecord<double, N> record;
    Lanes<double, N> miss_squared;
    for (std::int64_t first = 0; first < r.count; first += N) {
        const int used_lanes = static_cast<int>(r.count - first < N ? r.count - first : N);
        for (int k = 0; k < N; ++k) targets.set(k, r.targets[first + (k < used_lanes ? k : 0)]);
        arguments = targets;
        for (int step = 0; step < kMaxSteps; ++step) {
            entries_at(*r.map, arguments, entries);
            start_rays(r, entries, rays);
            trace_lens(r.to_stop, rays);
            int any_off_target = 0;
            REALCAM_LANES
            for (int k = 0; k < N; ++k) {
                const double dx = targets.x[k] - rays.origin.x[k], dy = targets.y[k] - rays.origin.y[k];
                const double squared = select(rays.status[k] == 0, dx * dx + dy * dy, nan);
                const bool is_off_target = squared > r.miss * r.miss;
                miss_squared[k] = squared;
                arguments.x[k] += select(is_off_target, dx, 0.0);
                arguments.y[k] += select(is_off_target, dy, 0.0);
                any_off_target |= static_cast<int>(is_off_target);
            }
            if (any_off_target == 0) break;
        }
        start_rays(r, entries, rays);
        for (int k = 0; k < N; ++k) {
            record.optical_path[k] = 0;
            record.surface_index[k] = -1;
        }
        trace_lens(r.lens, rays, record);
        for (int k = 0; k < used_lanes; ++k) {
            const Vec2<double> target = targets[k], entry = entries[k];
            const bool inside = target.x * target.x + target.y * target.y <= r.map->reach * r.map->reach;
            AimedRay& ray = r.rays[first + k];
            if (!inside || !(miss_squared[k] <= r.miss * r.miss)) {
                ray = {RayStatus::no_convergence, {nan, nan}, {nan, nan, nan}, {nan, nan, nan}, nan};
                continue;
            }
            const double squared = entry.x * entry.x + entry.y * entry.y, d = r.inverse_distance;
            ray = {static_cast<RayStatus>(rays.status[k]), entry, rays.origin[k], rays.direction[k],
                   record.optical_path[k] + r.index * squared * d / (1 + std::sqrt(1 + squared * d * d))};
        }
    }
}

}  // namespace REALCAM_NAMESPACE
