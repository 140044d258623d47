#pragma once
#include <limits>

#include "../../math/lanes.hpp"

namespace REALCAM_NAMESPACE {

// Intersection of a ray with a sphere or conic, and refraction there.
//
// A ray is o + t p: o is its origin in the frame of the surface's vertex, mm, and p its optical direction, a unit
// vector times the refractive index of the medium, as in Hamilton's optics. By Snell's law a surface changes p only
// along its normal. `direction_sign` is +1 if the light crosses the surface towards the film (+z), -1 if towards the
// scene.
//
// The length of p is never replaced by the exact index. Rounding changes the length a little at each surface; formulas
// in which every term scales with p.p then describe the same ray, only longer, whereas a term n^2 would turn the error
// into an angle. So float32 images of a 200 mm f/1.9 are accurate to 0.06 um instead of 0.24 um.

/// Intersection of a ray with a surface, in the frame of the surface's vertex.
template <class T>
struct SurfaceHit {
    T parameter;  ///< t of o + t p: the distance over the index, mm; may be negative (surfaces overlapping at the rim)
    T along_normal;  ///< p . normal = n cos(incidence), signed: positive towards the film
    /// Unit normal. Its z is positive on the near cap, the part of the surface from its vertex to its equator, which is
    /// the part that a lens has.
    Vec3<T> normal;
    T discriminant;  ///< negative or NaN if the ray does not meet the surface

    /// True if the ray hits the near cap. Computed, not stored: gcc does not vectorise loops that keep a bool in an
    /// aggregate. An exact tangent is not a crossing, and a discriminant that left the range of T counts as a miss.
    REALCAM_INLINE bool met() const {
        return (discriminant > T(0)) & (discriminant <= std::numeric_limits<T>::max()) & (normal.z > T(0));
    }
};

/// Returns the intersection of the ray o + t p with a conic of revolution about the z axis, whose vertex is the origin.
/// `curvature`: 1/mm; `conic_factor`: 1 + k.
///
/// Curvature form: F = c (o.o + k oz^2) - 2 oz, G = pz - c (o.p + k oz pz), A = c (p.p + k pz^2), and the roots of A
/// t^2 - 2 G t + F = 0. At a root the gradient of the surface is (-cx, -cy, 1 - c(1+k)z), and its product with p is G -
/// A t = +-sqrt(G^2 - A F). So the direction sign with which the ray must cross the surface selects the root, also for
/// planes, past 90 degrees, and for light that travels backwards. Of the two forms of the root, F / (G + s) and (G - s)
/// / A, the one that does not cancel is used. p . normal is computed as G - A t from the root: near a tangent the
/// square root of the discriminant is off by the square root of a rounding error, and would not fit the point and its
/// normal.
template <class T>
REALCAM_INLINE SurfaceHit<T> intersect_conic(Vec3<T> o, Vec3<T> p, T curvature, T conic_factor, T direction_sign) {
    const T k = conic_factor - T(1);
    const T c = curvature;
    const T F = c * (dot(o, o) + k * o.z * o.z) - T(2) * o.z;
    const T G = p.z - c * (dot(o, p) + k * o.z * p.z);
    const T A = c * (dot(p, p) + k * p.z * p.z);
    const T discriminant = G * G - A * F;
    const T s = direction_sign * sqrt_or_zero(discriminant);
    const bool same_sign = G * direction_sign >= T(0);
    const T t = quotient(select(same_sign, F, G - s), select(same_sign, G + s, A));
    const Vec3<T> point = o + t * p;
    const Vec3<T> gradient = {-c * point.x, -c * point.y, T(1) - c * conic_factor * point.z};
    const T inverse_length = T(1) / length(gradient);
    return {t, (G - A * t) * inverse_length, inverse_length * gradient, discriminant};
}

/// Returns the parameter t at which a ray meets the vertex plane or, if nearly parallel to that plane, comes nearest to
/// the vertex. A conic is intersected from this point, so that the squared distance to it does not enter: with k = 1000
/// it would drown the sag.
template <class T>
REALCAM_INLINE T to_vertex_plane(Vec3<T> o, Vec3<T> p) {
    const T squared = dot(p, p);
    const bool is_nearly_parallel = p.z * p.z < T(0.01) * squared;
    return -select(is_nearly_parallel, dot(o, p), o.z) / select(is_nearly_parallel, squared, p.z);
}

/// Returns the intersection with a sphere or plane by the formulas of intersect_conic. The sphere's gradient is the
/// unit normal: one square root and one division.
template <class T>
REALCAM_INLINE SurfaceHit<T> intersect_sphere(Vec3<T> o, Vec3<T> p, T curvature, T direction_sign) {
    const T c = curvature;
    const T F = c * dot(o, o) - T(2) * o.z;
    const T G = p.z - c * dot(o, p);
    const T A = c * dot(p, p);
    const T discriminant = G * G - A * F;
    const T s = direction_sign * sqrt_or_zero(discriminant);
    const bool same_sign = G * direction_sign >= T(0);
    const T t = quotient(select(same_sign, F, G - s), select(same_sign, G + s, A));
    const Vec3<T> point = o + t * p;
    return {t, G - A * t, {-c * point.x, -c * point.y, T(1) - c * point.z}, discriminant};
}

template <class T>
struct Refraction {
    Vec3<T> direction;  ///< optical direction of the outgoing ray
    T radicand;  ///< squared n' cos(refraction); negative: total internal reflection
};

/// Refracts a ray by Snell's law, p' = p + (s' - s) N with s = p.N and s'^2 = n'^2 - n^2 + s^2: the tangential part of
/// n d is conserved. A mirror is n' = n with a reversed direction sign of the outgoing ray. `along_normal`: p.N.
///
/// n'^2 - n^2 is computed as squared_index_change = n'^2 / n^2 - 1, times p.p.
template <class T>
REALCAM_INLINE Refraction<T> refract(Vec3<T> p, Vec3<T> normal, T along_normal, T squared_index_change,
                                     T direction_sign_out) {
    const T radicand = along_normal * along_normal + squared_index_change * dot(p, p);
    const T change = direction_sign_out * sqrt_or_zero(radicand) - along_normal;
    return {p + change * normal, radicand};
}

}  // namespace REALCAM_NAMESPACE
