#pragma once
#include "../math/lanes.hpp"

namespace REALCAM_NAMESPACE {

/// Where a ray meets a surface, in the frame of its vertex.
template <class T>
struct SurfaceHit {
    T distance;      ///< along the ray, mm; may be negative (surfaces that overlap at the rim)
    T cosine;        ///< direction . normal, signed: positive towards the film
    Vec3<T> normal;  ///< unit, z positive on the near cap
    T discriminant;  ///< negative or NaN where the ray does not meet the surface

    /// No flag is stored: gcc does not vectorise loops that keep a bool in an aggregate.
    REALCAM_INLINE bool met() const { return (discriminant >= T(0)) & (normal.z > T(0)); }
};

/// Intersection with a conic of revolution (1 + k = conic_factor) around the z axis, vertex in the origin.
///
/// Curvature form: F = c (o.o + k oz^2) - 2 oz, G = dz - c (o.d + k oz dz), A = c (1 + k dz^2), and the roots of
/// A t^2 - 2 G t + F = 0. At a root the gradient of the surface is parallel to (-cx, -cy, 1 - c(1+k)z), and its
/// product with d is G - A t = +-sqrt(G^2 - A F). So the sense in which the ray must cross the surface picks the
/// root; this holds for planes, past 90 degrees, and for light that goes back.
/// The two forms of the root, F / (G + s) and (G - s) / A, are chosen such that nothing cancels.
template <class T>
REALCAM_INLINE SurfaceHit<T> intersect_conic(Vec3<T> o, Vec3<T> d, T curvature, T conic_factor, T sense) {
    const T k = conic_factor - T(1);
    const T c = curvature;
    const T F = c * (dot(o, o) + k * o.z * o.z) - T(2) * o.z;
    const T G = d.z - c * (dot(o, d) + k * o.z * d.z);
    const T A = c * (T(1) + k * d.z * d.z);
    const T discriminant = G * G - A * F;
    const T s = sense * sqrt_or_zero(discriminant);
    const bool same_sign = G * sense >= T(0);
    const T t = select(same_sign, F, G - s) / select(same_sign, G + s, A);
    const Vec3<T> p = o + t * d;
    const Vec3<T> gradient = {-c * p.x, -c * p.y, T(1) - c * conic_factor * p.z};
    const T inverse_length = T(1) / std::sqrt(dot(gradient, gradient));
    return {t, s * inverse_length, inverse_length * gradient, discriminant};
}

/// The same for a sphere, whose gradient is the unit normal: one square root and one division.
template <class T>
REALCAM_INLINE SurfaceHit<T> intersect_sphere(Vec3<T> o, Vec3<T> d, T curvature, T sense) {
    const T c = curvature;
    const T F = c * dot(o, o) - T(2) * o.z;
    const T G = d.z - c * dot(o, d);
    const T discriminant = G * G - c * F;
    const T s = sense * sqrt_or_zero(discriminant);
    const bool same_sign = G * sense >= T(0);
    const T t = select(same_sign, F, G - s) / select(same_sign, G + s, c);
    const Vec3<T> p = o + t * d;
    const Vec3<T> normal = {-c * p.x, -c * p.y, T(1) - c * p.z};
    return {t, s, normal, discriminant};
}

template <class T>
struct Refraction {
    Vec3<T> direction;
    T radicand;  ///< of s'; negative: total internal reflection
};

/// Snell's law in vector form, d' = mu d + (s' - mu s) N with s = d.N and s' = +-sqrt(1 - mu^2 (1 - s^2)), where
/// mu = n / n'. (The source paper, equation 3, prints mu where mu^2 is needed.) A mirror is mu = 1 with the sense
/// of the outgoing ray turned.
template <class T>
REALCAM_INLINE Refraction<T> refract(Vec3<T> d, Vec3<T> normal, T cosine, T mu, T sense_out) {
    const T k = T(1) - mu * mu * (T(1) - cosine * cosine);
    const T g = sense_out * sqrt_or_zero(k) - mu * cosine;
    return {mu * d + g * normal, k};
}

}  // namespace REALCAM_NAMESPACE
