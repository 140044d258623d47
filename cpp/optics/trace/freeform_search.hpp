#pragma once
#include "asphere.hpp"
#include "freeform.hpp"
#include "lens_rays.hpp"

namespace REALCAM_NAMESPACE {

// Intersection of rays with freeform surfaces, by the bracketed search of asphere.hpp. o is a ray's origin in the frame
// of the surface's vertex, mm, p its optical direction, t the parameter of a point o + t p. `direction_sign` is +1 if
// the ray must cross the surface towards the film, -1 if towards the scene.

/// Intersections of N rays with a freeform surface.
template <class T, int N>
struct FreeformHits {
    Lanes<T, N> parameter;  ///< ray parameter of the intersection, mm
    Lanes<T, N> slope_x, slope_y;  ///< slopes of the sag at the intersection
    Lanes<T, N> slack;  ///< tolerance minus residual of the search, mm; NaN: no bracket
};

namespace freeform_detail {

/// True for rays within 3 degrees of the vertex plane (0.0025 is the square of the sine), and for rays that travel
/// backwards.
template <class T>
REALCAM_INLINE bool goes_sideways(T direction_sign, Vec3<T> p) {
    return p.z * direction_sign * std::fabs(p.z) < T(0.0025) * dot(p, p);
}

/// True if a point lies outside the search region.
template <class T>
REALCAM_INLINE bool is_outside(const FreeformView<T>& form, T x, T y) {
    const T distance_x = std::fabs(x - form.middle_x), distance_y = std::fabs(y - form.middle_y);
    return (distance_x > form.half_x) | (distance_y > form.half_y) | (x * x + y * y > form.reach * form.reach);
}

/// Searches for the intersections of N rays by safeguarded Newton steps, as in improve_search, starting with the
/// brackets and estimates in `search`. Ends when every ray has reached its tolerance or has a bracket of NaN.
template <class T, int N>
REALCAM_HD inline void search_freeform(const FreeformView<T>& form, T direction_sign, const Vec3Lanes<T, N>& origin,
                                       const Vec3Lanes<T, N>& direction, AsphereSearch<T, N>& search,
                                       FreeformHits<T, N>& hits) {
    FreeformSags<T, N> sags;
    Lanes<T, N> x, y;
    for (int step = 0; step < kMaxAsphereSteps<T>; ++step) {
        const bool halve = step >= kNewtonSteps && step % 2 == 0;
        REALCAM_LANES
        for (int i = 0; i < N; ++i) {
            x[i] = origin.x[i] + search.t[i] * direction.x[i];
            y[i] = origin.y[i] + search.t[i] * direction.y[i];
        }
        freeform_sags(form, x, y, sags);
        int searching = 0;
        REALCAM_LANES
        for (int i = 0; i < N; ++i) {
            const Vec3<T> o = origin[i], p = direction[i];
            const T t = search.t[i], gx = sags.slope_x[i], gy = sags.slope_y[i];
            const T f = o.z + t * p.z - sags.height[i], slope = p.z - gx * p.x - gy * p.y;
            const T axial =
                std::fabs(o.z) + std::fabs(t * p.z) + sags.size[i] + kSagRangeWeight<T> * (form.sag_max - form.sag_min);
            const T lateral = std::fabs(gx) * (std::fabs(o.x) + std::fabs(t * p.x)) +
                              std::fabs(gy) * (std::fabs(o.y) + std::fabs(t * p.y));
            const T max_lateral = kSteepest<T> * axial;
            const T tolerance = kRoundingErrors<T> * (axial + select(lateral < max_lateral, lateral, max_lateral));
            const bool is_right_direction = slope * direction_sign >= T(0);
            const T residual = select(is_right_direction, std::fabs(f), std::numeric_limits<T>::max());
            const T below = select(f <= T(0), t, search.below[i]), above = select(f > T(0), t, search.above[i]);
            const T newton = t - f / slope;
            const bool inside = (newton - below) * (above - newton) > T(0);
            const T next = select(inside & is_right_direction & !halve, newton, T(0.5) * (below + above));
            search.below[i] = below;
            search.above[i] = above;
            search.t[i] = select(residual <= tolerance, t, next);
            hits.parameter[i] = t;
            hits.slope_x[i] = gx;
            hits.slope_y[i] = gy;
            hits.slack[i] = tolerance - residual;
            searching |= static_cast<int>(residual > tolerance);
        }
        if (searching == 0) break;
    }
}

/// Finds a bracket on the part of the ray inside the search region and between the planes that bound the sag there
/// (find_bracket_on_ray). Returns false, with `t`, `below` and `above` unchanged, if there is no crossing.
template <class T>
REALCAM_HD inline bool find_bracket(const FreeformView<T>& form, T direction_sign, Vec3<T> o, Vec3<T> p, T& t, T& below,
                                    T& above) {
    T first = -std::numeric_limits<T>::max(), last = std::numeric_limits<T>::max();
    // Restricts the ray parameters [first, last] to those at which low <= origin + t direction <= high, for one axis.
    const auto restrict_to_slab = [&](T origin, T direction, T low, T high) {
        if (direction == T(0)) {
            if (origin < low || origin > high) last = -std::numeric_limits<T>::max();
            return;
        }
        const T a = (low - origin) / direction, b = (high - origin) / direction;
        const T from = a < b ? a : b, to = a < b ? b : a;
        first = from > first ? from : first;
        last = to < last ? to : last;
    };
    restrict_to_slab(o.x, p.x, form.middle_x - form.half_x, form.middle_x + form.half_x);
    restrict_to_slab(o.y, p.y, form.middle_y - form.half_y, form.middle_y + form.half_y);
    restrict_to_slab(o.z, p.z, form.sag_min, form.sag_max);
    const T across = p.x * p.x + p.y * p.y;
    if (across > T(0)) {
        const T middle = -(o.x * p.x + o.y * p.y) / across, x = o.x + middle * p.x, y = o.y + middle * p.y;
        const T half_chord_squared = form.reach * form.reach - x * x - y * y;
        if (!(half_chord_squared > T(0))) return false;
        const T half = std::sqrt(half_chord_squared / across);
        first = middle - half > first ? middle - half : first;
        last = middle + half < last ? middle + half : last;
    }
    if (!(first < last)) return false;
    // Slightly shortened: at the very edge the sag's slope is already that of its continuation.
    const T half = (T(1) - T(16) * std::numeric_limits<T>::epsilon()) * T(0.5) * (last - first);
    const auto sample = [&](T parameter) -> RaySample<T> {
        const Vec3<T> point = o + parameter * p;
        const Lanes<T, 1> x = {point.x}, y = {point.y};
        FreeformSags<T, 1> sag;
        freeform_sags<T, 1>(form, x, y, sag);
        return {parameter, direction_sign * (point.z - sag.height[0]),
                direction_sign * (p.z - sag.slope_x[0] * p.x - sag.slope_y[0] * p.y)};
    };
    return find_bracket_on_ray(T(0.5) * (first + last), half, direction_sign, sample, t, below, above);
}

/// Searches for the intersection of one ray with the surface inside the search region, for sideways rays and for rays
/// whose search failed or ended on the surface's continuation. Replaces the hit of the lane; if there is no crossing, a
/// hit on the continuation remains.
template <class T, int N>
REALCAM_HD inline void search_inside(const FreeformView<T>& form, T direction_sign, Vec3<T> o, Vec3<T> p, int lane,
                                     FreeformHits<T, N>& hits) {
    AsphereSearch<T, 1> search;
    if (!find_bracket(form, direction_sign, o, p, search.t[0], search.below[0], search.above[0])) {
        if (!(hits.slack[lane] >= T(0))) hits.slack[lane] = std::numeric_limits<T>::quiet_NaN();
        return;
    }
    Vec3Lanes<T, 1> origin, direction;
    origin.set(0, o);
    direction.set(0, p);
    FreeformHits<T, 1> hit;
    search_freeform<T, 1>(form, direction_sign, origin, direction, search, hit);
    hits.parameter[lane] = hit.parameter[0];
    hits.slope_x[lane] = hit.slope_x[0];
    hits.slope_y[lane] = hit.slope_y[0];
    hits.slack[lane] = hit.slack[0];
}

}  // namespace freeform_detail

/// Intersects N rays with a freeform surface. The slack of rays whose status is not ok is NaN.
template <class T, int N>
REALCAM_HD inline void find_freeform_crossings(const SurfaceView<T>& surface, const FreeformView<T>& form,
                                               const LensRays<T, N>& rays, FreeformHits<T, N>& hits) {
    using namespace freeform_detail;
    constexpr T nan = std::numeric_limits<T>::quiet_NaN();
    const T sign = surface.direction_sign_in;
    AsphereSearch<T, N> search;
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        const Vec3<T> o = rays.origin[i], p = rays.direction[i];
        const SurfaceHit<T> start = intersect_sphere(o, p, surface.curvature, sign);
        const T per_z = T(1) / select(p.z == T(0), T(1), p.z);
        const T below = (form.sag_min - o.z) * per_z, above = (form.sag_max - o.z) * per_z;
        const bool inside = (start.parameter - below) * (above - start.parameter) >= T(0);
        const bool searches = (rays.status[i] == 0) & !goes_sideways(sign, p);
        search.below[i] = select(searches, below, nan);
        search.above[i] = select(searches, above, nan);
        search.t[i] = select(searches, select(start.met() & inside, start.parameter, T(0.5) * (below + above)), nan);
    }
    search_freeform(form, sign, rays.origin, rays.direction, search, hits);
    for (int i = 0; i < N; ++i) {
        if (rays.status[i] != 0) continue;
        const Vec3<T> o = rays.origin[i], p = rays.direction[i];
        const T t = hits.parameter[i];
        if (!(hits.slack[i] >= T(0)) || is_outside(form, o.x + t * p.x, o.y + t * p.y))
            search_inside(form, sign, o, p, i, hits);
    }
}

/// Returns the hit of a finished search on a freeform surface, like asphere_hit.
template <class T>
REALCAM_INLINE SurfaceHit<T> freeform_hit(T direction_sign, Vec3<T> p, T t, T slope_x, T slope_y, T slack) {
    const Vec3<T> normal = normalized(Vec3<T>{-slope_x, -slope_y, T(1)});
    const T along_normal = dot(p, normal);
    const T crossing = along_normal * direction_sign;
    return {t, along_normal, normal, select(crossing < slack, crossing, slack)};
}

}  // namespace REALCAM_NAMESPACE
