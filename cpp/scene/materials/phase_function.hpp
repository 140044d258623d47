#pragma once
#include "../../math/sampling.hpp"

namespace REALCAM_NAMESPACE {

// Phase function of Henyey and Greenstein (1941), per steradian: both the fraction of the light that is scattered into
// a direction and the density with which that direction is sampled.

/// Value for a cosine of the scattering angle. `anisotropy`: mean cosine, between -1 and 1.
REALCAM_INLINE float henyey_greenstein(float anisotropy, float cosine) {
    const float g2 = anisotropy * anisotropy, squared = 1.0f + g2 - 2.0f * anisotropy * cosine;
    return kSpherePdf * (1.0f - g2) / (squared * std::sqrt(squared));
}

/// Samples the direction of scattered light. `direction`: unit vector along which the light, or a path, arrives.
REALCAM_INLINE Vec3f sample_henyey_greenstein(float anisotropy, Vec3f direction, Vec2f u) {
    // The usual inverse of the cumulative distribution divides by g. This form, with that division carried out, is
    // accurate for all g.
    const float g = anisotropy, v = 2.0f * u.x - 1.0f, denominator = 1.0f + g * v;
    const float ratio =
        (v + 0.5f * g * (v * v + 3.0f) + g * g * v + 0.5f * g * g * g * (v * v - 1.0f)) / (denominator * denominator);
    const float cosine = select(ratio < 1.0f, at_least(ratio, -1.0f), 1.0f);
    const float sine = sqrt_or_zero(1.0f - cosine * cosine);
    const Vec2f azimuth = cos_sin_of_turn(u.y);
    Vec3f s, t;
    tangent_frame(direction, s, t);
    return (sine * azimuth.x) * s + (sine * azimuth.y) * t + cosine * direction;
}

}  // namespace REALCAM_NAMESPACE
