#pragma once
#include <limits>

#include "lens_view.hpp"
#include "refraction.hpp"

namespace REALCAM_NAMESPACE {

template <class T>
struct Sag {
    T height;      ///< z of the surface, mm
    T size;  ///< absolute values of the conic and of each term, added up, mm: the terms may cancel, their rounding
             ///< errors do not
    T derivative;  ///< d height / d (r^2)
};

/// Even asphere: z(r) = c r^2 / (1 + sqrt(1 - (1+k) c^2 r^2)) + a4 r^4 + a6 r^6 + ...
/// Outside the search radius the sag continues as a constant, so that a search never meets the square root of a
/// negative number or a diverging polynomial.
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

/// Search state of N lanes: a root of f(t) = z(t) - sag(r^2(t)). `below` and `above` are ray parameters with f <= 0
/// (scene side of the surface) and f >= 0 (film side), in whichever order the ray reaches them. They bracket a crossing
/// in the required direction. NaN: the ray misses the surface.
template <class T, int N>
struct AsphereSearch {
    Lanes<T, N> t, below, above;
    Lanes<T, N> residual, tolerance;  ///< |f|, and the size that rounding alone can give it
};

/// Newton steps are taken alone for as many steps as suffice for lenses that can be made. After that every other step
/// bisects the bracket, which bounds the number of steps for any surface: 2^-digits of a bracket that is at most 2^8
/// times the scale.
inline constexpr int kNewtonSteps = 6;
template <class T>
inline constexpr int kMaxAsphereSteps = kNewtonSteps + 2 * (std::numeric_limits<T>::digits + 8);

/// Largest lateral rounding error counted in the tolerance, in units of the axial one: 1 / (16 sqrt(epsilon)).
template <class T>
inline constexpr T kSteepest = std::numeric_limits<T>::digits == 24 ? T(181) : T(4194304);

/// Marks sideways rays in begin_search; larger than any squared radius.
template <class T>
inline constexpr T kSideways = std::numeric_limits<T>::max() / 4;

/// Starts the search for a ray that crosses the planes that bound the sag; these planes are its bracket. Returns the
/// squared distance from the axis at which the ray crosses the plane of the surface's edge, minus the squared search
/// radius. If it is positive, the only crossing in this bracket may be one with the continuation outside. Adds
/// kSideways for sideways rays.
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
    // Within 3 degrees of the vertex plane, or backwards, as for rays in front of a fisheye.
    const bool sideways = p.z * surface.direction_sign_in * std::fabs(p.z) < T(0.0025) * dot(p, p);
    // A sum, because gcc would compile a select to a branch.
    return x * x + y * y - surface.search_squared + select(sideways, kSideways<T>, T(0));
}

/// A point on a ray: its parameter, the signed axial distance by which it lies beyond the surface, and the derivative
/// of that distance.
template <class T>
struct RaySample {
    T parameter, beyond, slope;
};

/// Finds the first sub-interval of a ray, between `middle` - `half` and `middle` + `half`, that begins on the near side
/// of the surface and ends on its far side. If the ray approaches the surface and recedes again within a sub-interval,
/// the turning point may lie on the other side and is searched for. `sample` returns the RaySample of a parameter.
/// Returns false, with the bracket unchanged, if there is no crossing.
template <class T, class Sample>
REALCAM_HD inline bool find_bracket_on_ray(T middle, T half, T direction_sign, Sample&& sample, T& t, T& below,
                                           T& above) {
    constexpr int kPieces = 16, kTurnSteps = std::numeric_limits<T>::digits;
    const auto bracketed = [&](T near, T far) {
        below = direction_sign > T(0) ? near : far;
        above = direction_sign > T(0) ? far : near;
        t = T(0.5) * (below + above);
        return true;
    };
    RaySample<T> near = sample(middle - half);
    for (int i = 1; i <= kPieces; ++i) {
        const RaySample<T> far = sample(middle + (T(2) / kPieces * static_cast<T>(i) - T(1)) * half);
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

/// Finds a bracket for a ray that goes sideways or crosses outside the search radius, along its path through the search
/// cylinder. Returns false if there is no crossing.
template <class T>
REALCAM_HD inline bool find_bracket(const SurfaceView<T>& surface, Vec3<T> o, Vec3<T> p, T& t, T& below, T& above) {
    const T across = p.x * p.x + p.y * p.y;
    const T middle = -(o.x * p.x + o.y * p.y) / across;
    const T x = o.x + middle * p.x, y = o.y + middle * p.y;
    const T room = surface.search_squared - x * x - y * y;
    if (!(room > T(0))) return false;
    // Slightly shortened: at the very edge the sag's slope is already that of its continuation.
    const T half = (T(1) - T(16) * std::numeric_limits<T>::epsilon()) * std::sqrt(room / across);
    const auto sample = [&](T parameter) -> RaySample<T> {
        const Vec3<T> at = o + parameter * p;
        const Sag<T> sag = asphere_sag(surface, at.x * at.x + at.y * at.y);
        return {parameter, surface.direction_sign_in * (at.z - sag.height),
                surface.direction_sign_in * (p.z - T(2) * sag.derivative * (at.x * p.x + at.y * p.y))};
    };
    return find_bracket_on_ray(middle, half, surface.direction_sign_in, sample, t, below, above);
}

/// One safeguarded Newton step. `halve`: bisects the bracket instead.
template <class T>
REALCAM_INLINE void improve_search(const SurfaceView<T>& surface, Vec3<T> o, Vec3<T> p, bool halve, T& t, T& below,
                                   T& above, T& residual, T& tolerance) {
    constexpr T eps = std::numeric_limits<T>::epsilon();
    const Vec3<T> at = o + t * p;
    const Sag<T> sag = asphere_sag(surface, at.x * at.x + at.y * at.y);
    const T f = at.z - sag.height;
    const T slope = p.z - T(2) * sag.derivative * (at.x * p.x + at.y * p.y);
    // Axial: rounding errors of z(t) and of the sag. Lateral: the effect of rounding errors of x(t) and y(t) on a steep
    // surface. It is capped, since a surface may be arbitrarily steep: there the bracket has to shrink until the height
    // fits too. The sag range is included because for a ray that starts on the vertex all other lengths are 0.
    const T axial = std::fabs(o.z) + std::fabs(t * p.z) + sag.size + T(0.0625) * (surface.sag_max - surface.sag_min);
    const T lateral = std::fabs(T(2) * sag.derivative) * (std::fabs(at.x) * (std::fabs(o.x) + std::fabs(t * p.x)) +
                                                          std::fabs(at.y) * (std::fabs(o.y) + std::fabs(t * p.y)));
    const T most = kSteepest<T> * axial;
    tolerance = T(4) * eps * (axial + select(lateral < most, lateral, most));
    // A root that is crossed in the wrong direction does not count.
    const bool right_direction_sign = slope * surface.direction_sign_in >= T(0);
    residual = select(right_direction_sign, std::fabs(f), std::numeric_limits<T>::max());
    // At f == 0 only `below` moves: moving both would leave nothing but this root, even if its direction is wrong.
    below = select(f <= T(0), t, below);
    above = select(f > T(0), t, above);
    const T newton = t - f / slope;
    const bool inside = (newton - below) * (above - newton) > T(0);
    const T next = select(inside & right_direction_sign & !halve, newton, T(0.5) * (below + above));
    t = select(residual <= tolerance, t, next);
}

/// Returns the hit of a finished search. `slack`: tolerance minus residual. A hit counts if `slack` and the component
/// of the crossing in the required direction are positive; the smaller of them is the discriminant, because gcc does
/// not vectorise a chain of booleans here.
template <class T>
REALCAM_INLINE SurfaceHit<T> asphere_hit(const SurfaceView<T>& surface, Vec3<T> o, Vec3<T> p, T t, T slope, T slack) {
    const Vec3<T> at = o + t * p;
    const Vec3<T> normal = normalized(Vec3<T>{-slope * at.x, -slope * at.y, T(1)});
    const T along_normal = dot(p, normal);
    const T crossing = along_normal * surface.direction_sign_in;
    return {t, along_normal, normal, select(crossing < slack, crossing, slack)};
}

/// A ray that crosses the vertex plane steeply, as a function of its height z above that plane:
/// r^2 = plane + 2 change z + spread z^2, in units of the squared search radius.
template <class T>
struct HeightRay {
    T per_height;  ///< ray parameter per height
    T plane, change, spread;

    REALCAM_INLINE T half_derivative(T z) const { return change + spread * z; }
    REALCAM_INLINE T share(T z) const { return plane + z * (half_derivative(z) + change); }
};

template <class T>
REALCAM_INLINE HeightRay<T> height_ray(const SurfaceView<T>& surface, Vec3<T> o, Vec3<T> p) {
    const T per_height = quotient(T(1), p.z), to_plane = -o.z * per_height;
    const T x = o.x + to_plane * p.x, y = o.y + to_plane * p.y;
    const T dx = per_height * p.x, dy = per_height * p.y, unit = surface.inverse_search_squared;
    return {per_height, unit * (x * x + y * y), unit * (x * dx + y * dy), unit * (dx * dx + dy * dy)};
}

/// True if a ray crosses the surface exactly once, and in the required direction. While its height lies between the
/// sag's bounds, its distance from the axis is largest at one of these bounds. If it rises faster than the surface
/// anywhere inside, its height above the surface increases monotonically. False for directions whose squares leave the
/// range of T.
template <class T>
REALCAM_INLINE bool crosses_once(const SurfaceView<T>& surface, const HeightRay<T>& ray) {
    const T at_min = ray.share(surface.sag_min), at_max = ray.share(surface.sag_max);
    const bool inside = (at_min < surface.inner_share) & (at_max < surface.inner_share);
    return (ray.spread < select(inside, surface.crossed_once_inside, surface.crossed_once)) &
           (ray.per_height * surface.direction_sign_in > T(1e-18));
}

/// Height at which a ray meets the starting paraboloid, improved by two Newton steps on the polynomial `start`.
/// `inverse_rise`: about 1 / (d/dz of the height above the surface).
template <class T>
REALCAM_INLINE T start_height(const SurfaceView<T>& surface, const HeightRay<T>& ray, T& inverse_rise) {
    const T bend = T(2) * surface.start_parabola, rise = T(1) - bend * ray.change;
    const T root = sqrt_or_zero(rise * rise - bend * bend * ray.plane * ray.spread);
    T z = quotient(bend * ray.plane, rise + root);
    REALCAM_UNROLL
    for (int step = 0; step < 2; ++step) {
        const T share = ray.share(z), u = select(share < T(1), share, T(1));
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

/// Newton steps at most: one or two confirm the starting height, and two more suffice for float64.
inline constexpr int kHeightSteps = 4;

}  // namespace REALCAM_NAMESPACE
