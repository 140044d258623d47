#pragma once
#include <limits>

#include "asphere.hpp"

namespace REALCAM_NAMESPACE {

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
