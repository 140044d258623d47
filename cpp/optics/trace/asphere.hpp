#pragma once
#include <limits>

#include "lens_view.hpp"
#include "refraction.hpp"

namespace REALCAM_NAMESPACE {

// Intersection of rays with even aspheres. o is a ray's origin in the frame of the surface's vertex, mm, p its optical
// direction, t the parameter of a point o + t p.

/// Sag of a surface of revolution at one distance from the axis.
template <class T>
struct Sag {
    T height;  ///< z of the surface, mm
    T size;  ///< sum of the absolute values of the conic and of each term, mm: the terms may cancel, their rounding
             ///< errors do not
    T derivative;  ///< d height / d (r^2), 1/mm
};

/// Returns the sag of an even asphere: z(r) = c r^2 / (1 + sqrt(1 - (1+k) c^2 r^2)) + a4 r^4 + a6 r^6 + ... Outside the
/// search radius the sag continues as a constant, so that a search never meets the square root of a negative number or
/// a diverging polynomial. `radius_squared`: r^2, mm^2.
template <class T>
REALCAM_INLINE Sag<T> asphere_sag(const SurfaceView<T>& surface, T radius_squared) {
    using std::fabs;  // dual numbers bring their own overload
    const T r2 = select(radius_squared < surface.search_squared, radius_squared, surface.search_squared);
    const T root = sqrt_or_zero(T(1) - surface.conic_factor * surface.curvature * surface.curvature * r2);
    const T u = r2 * surface.inverse_search_squared, from_middle = u - T(0.5);
    T polynomial = 0, slope = 0, sizes = 0;  // Horner scheme: p(u) = a4 + a6 u + ..., its derivative, term sizes
    // All terms, zeros included: a constant trip count unrolls, so that the loop over the lanes vectorises.
    REALCAM_UNROLL
    for (int i = kMaxAsphericTerms - 1; i >= 0; --i) {
        slope = slope * from_middle + polynomial;
        polynomial = polynomial * from_middle + surface.aspheric[i];
        sizes = sizes * T(0.5) + fabs(surface.aspheric[i]);  // the bound for all rays, at the axis and the rim
    }
    const T base = quotient(surface.curvature * r2, T(1) + root), departure = u * u * polynomial;
    const T derivative =
        surface.curvature / (T(2) * root) + surface.inverse_search_squared * u * (T(2) * polynomial + u * slope);
    return {base + departure, fabs(base) + u * u * sizes,
            select(radius_squared <= surface.search_squared, derivative, T(0))};
}

/// State of N searches for a root of f(t) = z(t) - sag(r^2(t)), the axial distance of a point of the ray from the
/// surface. `below` and `above` are ray parameters with f <= 0 (scene side of the surface) and f >= 0 (film side), in
/// whichever order the ray reaches them. They bracket a crossing in the required direction. If the ray misses the
/// surface, they are NaN.
template <class T, int N>
struct AsphereSearch {
    Lanes<T, N> t, below, above;  ///< current estimate, and bracket
    /// |f| at t, or the largest number if the ray crosses in the wrong direction; and the |f| that rounding errors
    /// alone can cause, mm.
    Lanes<T, N> residual, tolerance;
};

/// Number of steps that are all Newton steps; it suffices for lenses that can be made. After that every other step
/// bisects the bracket.
inline constexpr int kNewtonSteps = 6;
/// Largest number of steps. The bisections among them reduce any bracket to a rounding error: its length is at most 2^8
/// times the scale of the surface, and a rounding error is 2^-digits of that scale.
template <class T>
inline constexpr int kMaxAsphereSteps = kNewtonSteps + 2 * (std::numeric_limits<T>::digits + 8);

/// Rounding error of a residual, relative to the sum of the lengths that enter it: four roundings.
template <class T>
inline constexpr T kRoundingErrors = T(4) * std::numeric_limits<T>::epsilon();

/// Weight of the range of the sag in the tolerance of a search: small, but enough for rays that start on the vertex,
/// for which all other lengths are 0.
template <class T>
inline constexpr T kSagRangeWeight = T(0.0625);

/// Largest lateral rounding error counted in the tolerance, in units of the axial one: 1 / (16 sqrt(epsilon)).
/// Literals, because std::sqrt is not constexpr.
template <class T>
inline constexpr T kSteepest = std::numeric_limits<T>::digits == 24 ? T(181) : T(4194304);

/// Added by begin_search for sideways rays, which are rays within 3 degrees of the vertex plane and rays that travel
/// backwards. Larger than any squared radius.
template <class T>
inline constexpr T kSideways = std::numeric_limits<T>::max() / 4;

/// Starts a search with the bracket between the two planes z = sag_min and z = sag_max, and with the intersection with
/// the conic as the first estimate `t`. Returns the squared distance from the axis at which the ray crosses the plane
/// of the surface's edge, minus the squared search radius, mm^2, plus kSideways for sideways rays. If the result is
/// positive, the only crossing in this bracket may be one with the continuation outside the search radius, and
/// find_bracket has to look for one inside.
template <class T>
REALCAM_INLINE T begin_search(const SurfaceView<T>& surface, Vec3<T> o, Vec3<T> p, T& t, T& below, T& above) {
    const SurfaceHit<T> conic =
        intersect_conic(o, p, surface.curvature, surface.conic_factor, surface.direction_sign_in);
    const T per_z = T(1) / select(p.z == T(0), T(1), p.z);
    below = (surface.sag_min - o.z) * per_z;
    above = (surface.sag_max - o.z) * per_z;
    const bool inside = (conic.parameter - below) * (above - conic.parameter) >= T(0);
    t = select(conic.met() & inside, conic.parameter, T(0.5) * (below + above));
    const T to_edge = (surface.sag_edge - o.z) * per_z;
    const T x = o.x + to_edge * p.x, y = o.y + to_edge * p.y;
    // Rays within 3 degrees of the vertex plane (0.0025 is the square of the sine), or backwards, as in front of a
    // fisheye.
    const bool sideways = p.z * surface.direction_sign_in * std::fabs(p.z) < T(0.0025) * dot(p, p);
    // A sum, because gcc would compile a select to a branch.
    return x * x + y * y - surface.search_squared + select(sideways, kSideways<T>, T(0));
}

/// A point on a ray.
template <class T>
struct RaySample {
    T parameter;  ///< t
    T beyond;  ///< axial distance by which the point lies beyond the surface, in the direction of the light, mm
    T slope;  ///< d beyond / d t
};

/// Finds the first of 16 equal sub-intervals of the ray parameters [middle - half, middle + half] that begins in front
/// of the surface and ends beyond it. If the ray approaches the surface and recedes again within a sub-interval, the
/// turning point may lie on the other side of the surface and is searched for by bisection. `sample(t)` returns the
/// RaySample at the parameter t. Returns true, with the bracket in `below` and `above` and its midpoint in `t`; or
/// false, with all three unchanged, if there is no crossing.
template <class T, class Sample>
REALCAM_HD inline bool find_bracket_on_ray(T middle, T half, T direction_sign, Sample&& sample, T& t, T& below,
                                           T& above) {
    constexpr int kIntervals = 16, kTurnSteps = std::numeric_limits<T>::digits;
    const auto bracketed = [&](T near, T far) {
        below = direction_sign > T(0) ? near : far;
        above = direction_sign > T(0) ? far : near;
        t = T(0.5) * (below + above);
        return true;
    };
    RaySample<T> near = sample(middle - half);
    for (int i = 1; i <= kIntervals; ++i) {
        const RaySample<T> far = sample(middle + (T(2) / kIntervals * static_cast<T>(i) - T(1)) * half);
        if (near.beyond < T(0) && far.beyond >= T(0)) return bracketed(near.parameter, far.parameter);
        const T side = near.beyond < T(0) ? T(-1) : T(1);
        if (side * far.beyond >= T(0) && side * near.slope < T(0) && side * far.slope > T(0)) {
            T low = near.parameter, high = far.parameter;
            for (int k = 0; k < kTurnSteps; ++k) {
                const RaySample<T> turn = sample(T(0.5) * (low + high));
                if (side * turn.beyond < T(0))
                    return side > T(0) ? bracketed(turn.parameter, far.parameter)
                                       : bracketed(near.parameter, turn.parameter);
                (side * turn.slope < T(0) ? low : high) = turn.parameter;
            }
        }
        near = far;
    }
    return false;
}

/// Finds a bracket for a sideways ray, or for one that crosses the edge's plane outside the search radius, along its
/// path through the search cylinder (the cylinder of the search radius about the axis). Returns false, with the bracket
/// unchanged, if there is no crossing.
template <class T>
REALCAM_HD inline bool find_bracket(const SurfaceView<T>& surface, Vec3<T> o, Vec3<T> p, T& t, T& below, T& above) {
    const T across = p.x * p.x + p.y * p.y;
    const T middle = -(o.x * p.x + o.y * p.y) / across;
    const T x = o.x + middle * p.x, y = o.y + middle * p.y;
    const T half_chord_squared = surface.search_squared - x * x - y * y;
    if (!(half_chord_squared > T(0))) return false;
    // Slightly shortened: at the very edge the sag's slope is already that of its continuation.
    const T half = (T(1) - T(16) * std::numeric_limits<T>::epsilon()) * std::sqrt(half_chord_squared / across);
    const auto sample = [&](T parameter) -> RaySample<T> {
        const Vec3<T> point = o + parameter * p;
        const Sag<T> sag = asphere_sag(surface, point.x * point.x + point.y * point.y);
        return {parameter, surface.direction_sign_in * (point.z - sag.height),
                surface.direction_sign_in * (p.z - T(2) * sag.derivative * (point.x * p.x + point.y * p.y))};
    };
    return find_bracket_on_ray(middle, half, surface.direction_sign_in, sample, t, below, above);
}

/// Performs one step of a search: Newton's method, or a bisection of the bracket if the Newton step would leave it or
/// `halve` is true. Sets `residual` and `tolerance` of the point at the old `t`; if the residual is within the
/// tolerance, `t` is unchanged. See AsphereSearch.
template <class T>
REALCAM_INLINE void improve_search(const SurfaceView<T>& surface, Vec3<T> o, Vec3<T> p, bool halve, T& t, T& below,
                                   T& above, T& residual, T& tolerance) {
    const Vec3<T> point = o + t * p;
    const Sag<T> sag = asphere_sag(surface, point.x * point.x + point.y * point.y);
    const T f = point.z - sag.height;
    const T slope = p.z - T(2) * sag.derivative * (point.x * p.x + point.y * p.y);
    // Axial: rounding errors of z(t) and of the sag. Lateral: the effect of rounding errors of x(t) and y(t) on a steep
    // surface. It is capped, since a surface may be arbitrarily steep: there the bracket has to shrink until the height
    // fits too.
    const T axial =
        std::fabs(o.z) + std::fabs(t * p.z) + sag.size + kSagRangeWeight<T> * (surface.sag_max - surface.sag_min);
    const T lateral = std::fabs(T(2) * sag.derivative) * (std::fabs(point.x) * (std::fabs(o.x) + std::fabs(t * p.x)) +
                                                          std::fabs(point.y) * (std::fabs(o.y) + std::fabs(t * p.y)));
    const T max_lateral = kSteepest<T> * axial;
    tolerance = kRoundingErrors<T> * (axial + select(lateral < max_lateral, lateral, max_lateral));
    // A root that is crossed in the wrong direction does not count.
    const bool is_right_direction = slope * surface.direction_sign_in >= T(0);
    residual = select(is_right_direction, std::fabs(f), std::numeric_limits<T>::max());
    // At f == 0 only `below` moves: moving both would leave nothing but this root, even if its direction is wrong.
    below = select(f <= T(0), t, below);
    above = select(f > T(0), t, above);
    const T newton = t - f / slope;
    const bool inside = (newton - below) * (above - newton) > T(0);
    const T next = select(inside & is_right_direction & !halve, newton, T(0.5) * (below + above));
    t = select(residual <= tolerance, t, next);
}

/// Returns the hit of a finished search at the ray parameter `t`. `slope`, `slack`: see AsphereHits in lens_trace.hpp.
/// A hit counts if `slack` and the component of the crossing in the required direction are positive; the smaller of
/// them is the discriminant, because gcc does not vectorise a chain of booleans here.
template <class T>
REALCAM_INLINE SurfaceHit<T> asphere_hit(const SurfaceView<T>& surface, Vec3<T> o, Vec3<T> p, T t, T slope, T slack) {
    const Vec3<T> point = o + t * p;
    const Vec3<T> normal = normalized(Vec3<T>{-slope * point.x, -slope * point.y, T(1)});
    const T along_normal = dot(p, normal);
    const T crossing = along_normal * surface.direction_sign_in;
    return {t, along_normal, normal, select(crossing < slack, crossing, slack)};
}

/// A ray that crosses the vertex plane steeply, as a function of its height z above that plane, mm. Along it u = r^2 /
/// search_squared is the quadratic polynomial u(z) = constant + 2 linear z + quadratic z^2.
template <class T>
struct HeightRay {
    T per_height;  ///< dt / dz, the change of the ray parameter per height
    T constant, linear, quadratic;

    /// Half of du/dz.
    REALCAM_INLINE T half_derivative(T z) const { return linear + quadratic * z; }
    REALCAM_INLINE T u(T z) const { return constant + z * (half_derivative(z) + linear); }
};

/// Returns the ray o + t p as a function of its height. Not finite if p is parallel to the vertex plane.
template <class T>
REALCAM_INLINE HeightRay<T> height_ray(const SurfaceView<T>& surface, Vec3<T> o, Vec3<T> p) {
    const T per_height = quotient(T(1), p.z), to_plane = -o.z * per_height;
    const T x = o.x + to_plane * p.x, y = o.y + to_plane * p.y;
    const T dx = per_height * p.x, dy = per_height * p.y, unit = surface.inverse_search_squared;
    return {per_height, unit * (x * x + y * y), unit * (x * dx + y * dy), unit * (dx * dx + dy * dy)};
}

/// True if a ray is known to cross the surface exactly once, and in the required direction. While its height lies
/// between the sag's bounds, its distance from the axis is largest at one of these bounds. If it is steeper than the
/// surface anywhere up to that distance, its height above the surface increases monotonically. False for directions
/// whose squares leave the range of T.
template <class T>
REALCAM_INLINE bool crosses_once(const SurfaceView<T>& surface, const HeightRay<T>& ray) {
    constexpr T kSmallest = T(1e-18);  // its square is still a normal float32
    const T u_at_min = ray.u(surface.sag_min), u_at_max = ray.u(surface.sag_max);
    const bool inside = (u_at_min < surface.inner_u) & (u_at_max < surface.inner_u);
    return (ray.quadratic < select(inside, surface.crossed_once_inside, surface.crossed_once)) &
           (ray.per_height * surface.direction_sign_in > kSmallest);
}

/// Returns the height z at which a ray meets the paraboloid SurfaceView::start_parabola, improved by two Newton steps
/// on the polynomial SurfaceView::start: an estimate of the intersection with the surface, mm. Sets `inverse_rise` to
/// about 1 / (df/dz), f(z) = z - sag.
template <class T>
REALCAM_INLINE T start_height(const SurfaceView<T>& surface, const HeightRay<T>& ray, T& inverse_rise) {
    const T bend = T(2) * surface.start_parabola, rise = T(1) - bend * ray.linear;
    const T root = sqrt_or_zero(rise * rise - bend * bend * ray.constant * ray.quadratic);
    T z = quotient(bend * ray.constant, rise + root);
    REALCAM_UNROLL
    for (int step = 0; step < 2; ++step) {
        const T u_of_ray = ray.u(z), u = select(u_of_ray < T(1), u_of_ray, T(1));
        T polynomial = surface.start[kStartTerms - 1], slope = 0;
        REALCAM_UNROLL
        for (int i = kStartTerms - 2; i >= 0; --i) {
            slope = slope * u + polynomial;
            polynomial = polynomial * u + surface.start[i];
        }
        // The second reciprocal is the first one refined by a Newton step.
        const T new_rise = T(1) - T(2) * (polynomial + u * slope) * ray.half_derivative(z);
        inverse_rise = step == 0 ? quotient(T(1), new_rise) : inverse_rise * (T(2) - new_rise * inverse_rise);
        z -= (z - u * polynomial) * inverse_rise;
    }
    return z;
}

/// Largest number of Newton steps on heights: one or two confirm the starting height, and two more suffice for float64.
inline constexpr int kHeightSteps = 4;

}  // namespace REALCAM_NAMESPACE
