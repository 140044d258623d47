#pragma once
#include "../math/color.hpp"

namespace REALCAM_NAMESPACE {

REALCAM_INLINE float fifth_power(float v) {
    const float v2 = v * v;
    return v2 * v2 * v;
}

/// Schlick's approximation (1994): f0 at normal, f90 at grazing incidence.
REALCAM_INLINE Color schlick(Color f0, float f90, float cosine) {
    return mix(f0, grey(f90), fifth_power(1.0f - cosine));
}

/// Fresnel reflectance of a dielectric interface for unpolarised light; 1 for total reflection. `eta`: index behind the
/// interface over the index in front of it; `cosine` > 0: of the angle of incidence.
REALCAM_INLINE float dielectric_fresnel(float cosine, float eta) {
    const float sine2_beyond = (1.0f - cosine * cosine) / (eta * eta);
    if (!(sine2_beyond < 1.0f)) return 1.0f;
    const float beyond = std::sqrt(1.0f - sine2_beyond);
    const float parallel = (eta * cosine - beyond) / (eta * cosine + beyond);
    const float perpendicular = (cosine - eta * beyond) / (cosine + eta * beyond);
    return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

}  // namespace REALCAM_NAMESPACE
