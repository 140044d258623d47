#pragma once
#include "../math/lanes.hpp"
#include "../math/sincos.hpp"

namespace REALCAM_NAMESPACE {

// Microfacet distribution of Trowbridge and Reitz (GGX; Walter et al. 2007), in a frame whose z axis is the surface
// normal. `alpha`: root mean square slope, which is glTF's roughness squared.

/// Below this alpha a lobe is narrower than float directions resolve, and is treated as a mirror.
inline constexpr float kSmoothAlpha = 1e-3f;

/// Normal distribution D(h), per steradian.
REALCAM_INLINE float ggx_density(Vec3f h, float alpha) {
    // h.z^2 (alpha^2 - 1) + 1, without its cancellation at h.z = 1.
    const float a2 = alpha * alpha, k = h.x * h.x + h.y * h.y + a2 * h.z * h.z;
    return a2 / (3.141592654f * k * k);
}

/// Smith's Lambda function.
REALCAM_INLINE float ggx_lambda(Vec3f w, float alpha) {
    const float tangent2 = (w.x * w.x + w.y * w.y) / (w.z * w.z);
    return 0.5f * (std::sqrt(1.0f + alpha * alpha * tangent2) - 1.0f);
}

/// Smith masking function G1.
REALCAM_INLINE float ggx_visible(Vec3f w, float alpha) {
    return 1.0f / (1.0f + ggx_lambda(w, alpha));
}

/// Height-correlated masking-shadowing function G2 (Heitz 2014). For directions on different sides of the surface,
/// where Heitz derives a Beta function of the Lambdas, the same form is used.
REALCAM_INLINE float ggx_visible_to_both(Vec3f a, Vec3f b, float alpha) {
    return 1.0f / (1.0f + ggx_lambda(a, alpha) + ggx_lambda(b, alpha));
}

/// Samples a visible facet normal for w, w.z > 0 (Dupuy and Benyoub 2023).
REALCAM_INLINE Vec3f sample_ggx(Vec3f w, float alpha, Vec2f u) {
    const Vec3f stretched = normalized(Vec3f{alpha * w.x, alpha * w.y, w.z});
    const Vec2f azimuth = cos_sin_of_turn(u.y);
    const float z = (1.0f - u.x) * (1.0f + stretched.z) - stretched.z;
    const float radius = sqrt_or_zero(1.0f - z * z);
    const Vec3f h = Vec3f{radius * azimuth.x, radius * azimuth.y, z} + stretched;
    return normalized(Vec3f{alpha * h.x, alpha * h.y, h.z > 1e-6f ? h.z : 1e-6f});
}

/// Density of sample_ggx, per steradian of facet normals (not of reflected directions).
REALCAM_INLINE float ggx_pdf(Vec3f w, Vec3f h, float alpha) {
    const float cosine = dot(w, h);
    return cosine > 0.0f ? ggx_visible(w, alpha) * ggx_density(h, alpha) * cosine / w.z : 0.0f;
}

}  // namespace REALCAM_NAMESPACE
