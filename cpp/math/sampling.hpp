#pragma once
#include "lanes.hpp"
#include "sincos.hpp"

namespace REALCAM_NAMESPACE {

// Warps from the unit square [0, 1)^2 to discs, spheres and lobes, with their densities. Tests compare each warp with
// its density. Callers may divide by the density, or use a form in which common factors have cancelled.

inline constexpr float kInvPi = 0.3183098862f, kInv2Pi = 0.1591549431f;  ///< 1 / pi and 1 / (2 pi)

/// Samples the unit disc uniformly.
REALCAM_INLINE Vec2f sample_disc(Vec2f u) {
    const float radius = std::sqrt(u.y);
    const Vec2f azimuth = cos_sin_of_turn(u.x);
    return {radius * azimuth.x, radius * azimuth.y};
}

/// Density of sample_disc at a point of the plane, per unit area; 0 outside the disc.
REALCAM_INLINE float disc_pdf(Vec2f p) {
    return select(p.x * p.x + p.y * p.y <= 1.0f, kInvPi, 0.0f);
}

/// Computes unit vectors s and t such that (s, t, n) is a right-handed orthonormal frame, for a unit vector n (Duff et
/// al. 2017).
REALCAM_INLINE void tangent_frame(Vec3f n, Vec3f& s, Vec3f& t) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z), b = n.x * n.y * a;
    s = {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x};
    t = {b, sign + n.y * n.y * a, -n.y};
}

/// Density of sample_sphere, per steradian: 1 / (4 pi).
inline constexpr float kSpherePdf = 0.07957747155f;

/// Samples the unit sphere uniformly.
REALCAM_INLINE Vec3f sample_sphere(Vec2f u) {
    const float z = 1.0f - 2.0f * u.x, radius = sqrt_or_zero(1.0f - z * z);
    const Vec2f azimuth = cos_sin_of_turn(u.y);
    return {radius * azimuth.x, radius * azimuth.y, z};
}

/// Samples a direction about a unit vector n with density cosine / pi, per steradian.
REALCAM_INLINE Vec3f sample_cosine(Vec3f n, Vec2f u) {
    Vec3f s, t;
    tangent_frame(n, s, t);
    const float radius = std::sqrt(u.x), height = std::sqrt(1.0f - u.x);
    const Vec2f azimuth = cos_sin_of_turn(u.y);
    return (radius * azimuth.x) * s + (radius * azimuth.y) * t + height * n;
}

/// Density of sample_cosine, per steradian.
REALCAM_INLINE float cosine_pdf(Vec3f n, Vec3f direction) {
    const float cosine = dot(n, direction);
    return select(cosine > 0.0f, kInvPi * cosine, 0.0f);
}

/// Samples a direction about a unit vector with density (exponent + 1) / (2 pi) cosine^exponent, per steradian.
REALCAM_INLINE Vec3f sample_phong(Vec3f axis, float exponent, Vec2f u) {
    Vec3f s, t;
    tangent_frame(axis, s, t);
    // cosine^2 = (1 - u)^(2 / (exponent + 1)). The sine is computed first: one minus a rounded cosine would leave only
    // a few steps of angle in a narrow lobe.
    const float sine_squared = -std::expm1(2.0f / (exponent + 1.0f) * std::log1p(-u.x));
    const float radius = sqrt_or_zero(sine_squared), height = sqrt_or_zero(1.0f - sine_squared);
    const Vec2f azimuth = cos_sin_of_turn(u.y);
    return (radius * azimuth.x) * s + (radius * azimuth.y) * t + height * axis;
}

/// Density of sample_phong, per steradian.
REALCAM_INLINE float phong_pdf(Vec3f axis, float exponent, Vec3f direction) {
    // One minus the cosine is computed from the chord between the unit vectors: an exponent of 1e4 would amplify the
    // rounding error of a dot product to 1e-3.
    const Vec3f chord = axis - direction;
    const float one_minus_cosine = 0.5f * dot(chord, chord);
    if (!(one_minus_cosine < 1.0f)) return 0.0f;
    return (exponent + 1.0f) * kInv2Pi * std::exp(exponent * std::log1p(-one_minus_cosine));
}

/// Weight of a sample for multiple importance sampling, by Veach's power heuristic with exponent 2. `pdf`: density of
/// the technique that drew the sample; `other_pdf`: density of the other technique for the same sample. The weight is 1
/// if `pdf` is infinite (a delta distribution), because the other technique cannot draw such samples.
REALCAM_INLINE float mis_weight(float pdf, float other_pdf) {
    const float ratio = other_pdf / pdf;
    return 1.0f / (1.0f + ratio * ratio);
}

}  // namespace REALCAM_NAMESPACE
