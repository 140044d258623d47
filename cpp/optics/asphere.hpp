#pragma once
#include <limits>

#include "lens_view.hpp"
#include "refraction.hpp"

namespace REALCAM_NAMESPACE {

template <class T>
struct Sag {
    T height;      ///< z of the surface, mm
    T derivative;  ///< d height / d (r^2)
};

/// Even asphere: z(r) = c r^2 / (1 + sqrt(1 - (1+k) c^2 r^2)) + a4 r^4 + a6 r^6 + ...
/// Outside the search radius the sag goes on as a constant, so that a search never meets a square root of a
/// negative number or a polynomial run wild.
template <class T>
REALCAM_INLINE Sag<T> asphere_sag(const LensStep<T>& step, T radius_squared) {
    const T r2 = select(radius_squared < step.search_squared, radius_squared, step.search_squared);
    const T root = sqrt_or_zero(T(1) - step.conic_factor * step.curvature * step.curvature * r2);
    T polynomial = 0, slope = 0;  // Horner, of p(r^2) = a4 + a6 r^2 + ... and its derivative
    // Always all terms, zeros too: a constant count unrolls, and the loop over the lanes becomes vector code.
#pragma GCC unroll 8
    for (int i = kMaxAsphericTerms - 1; i >= 0; --i) {
        slope = slope * r2 + polynomial;
        polynomial = polynomial * r2 + step.aspheric[i];
    }
    const T height = step.curvature * r2 / (T(1) + root) + r2 * r2 * polynomial;
    const T derivative = step.curvature / (T(2) * root) + r2 * (T(2) * polynomial + r2 * slope);
    return {height, select(radius_squared < step.search_squared, derivative, T(0))};
}

/// Search state of one lane. `below` and `above` are ray parameters at which the ray is known to be on the scene
/// side and on the film side of the surface: a bracket, in whichever order the ray meets them.
template <class T, int N>
struct AsphereSearch {
    alignas(64) T t[N], below[N], above[N], residual[N], tolerance[N];
};

/// Both Newton's method and, where it leaves the bracket, bisection: 24 (float) or 53 (double) halvings and a few
/// Newton steps always suffice where there is a root.
template <class T>
inline constexpr int kMaxAsphereIterations = std::numeric_limits<T>::digits + 8;

template <class T>
REALCAM_INLINE void begin_search(const LensStep<T>& step, Vec3<T> o, Vec3<T> p, T& t, T& below, T& above) {
    const SurfaceHit<T> conic =
        intersect_conic(o, p, step.curvature, step.conic_factor, step.index_squared, step.sense_in);
    const T pz = select(p.z >= T(0), select(p.z > T(1e-6), p.z, T(1e-6)), select(p.z < T(-1e-6), p.z, T(-1e-6)));
    below = (step.sag_min - o.z) / pz;
    above = (step.sag_max - o.z) / pz;
    const bool inside = (conic.parameter - below) * (above - conic.parameter) >= T(0);
    t = select(conic.met() & inside, conic.parameter, T(0.5) * (below + above));
}

/// One safeguarded Newton step on f(t) = z(t) - sag(r^2(t)).
template <class T>
REALCAM_INLINE void improve_search(const LensStep<T>& step, Vec3<T> o, Vec3<T> p, T& t, T& below, T& above, T& residual,
                                   T& tolerance) {
    constexpr T eps = std::numeric_limits<T>::epsilon();
    const Vec3<T> at = o + t * p;
    const Sag<T> sag = asphere_sag(step, at.x * at.x + at.y * at.y);
    const T f = at.z - sag.height;
    const T slope = p.z - T(2) * sag.derivative * (at.x * p.x + at.y * p.y);
    residual = std::fabs(f);
    // What rounding alone can leave in f: the terms of z(t), the sag, and the sag's change with r.
    tolerance = T(4) * eps * (std::fabs(o.z) + std::fabs(t) + std::fabs(sag.height));
    below = select(f <= T(0), t, below);
    above = select(f >= T(0), t, above);
    const T newton = t - f / slope;
    const bool inside = (newton - below) * (above - newton) > T(0);
    const T next = select(inside, newton, T(0.5) * (below + above));
    t = select(residual <= tolerance, t, next);
}

/// `slack`: by how much the search ended within its tolerance. A hit counts where that is not negative and the ray
/// crosses in the right sense; one number says both, because gcc does not vectorise a chain of truth values here.
template <class T>
REALCAM_INLINE SurfaceHit<T> asphere_hit(const LensStep<T>& step, Vec3<T> o, Vec3<T> p, T t, T slack) {
    const Vec3<T> at = o + t * p;
    const T slope = T(2) * asphere_sag(step, at.x * at.x + at.y * at.y).derivative;
    const Vec3<T> normal = normalized(Vec3<T>{-slope * at.x, -slope * at.y, T(1)});
    const T along_normal = dot(p, normal);
    const T crossing = along_normal * step.sense_in;
    return {t, along_normal, normal, select(crossing < slack, crossing, slack)};
}

}  // namespace REALCAM_NAMESPACE
