#pragma once
#include "../math/sampling.hpp"

namespace REALCAM_NAMESPACE {

REALCAM_INLINE Vec3f mirrored_at(Vec3f normal, Vec3f direction) {
    return (2.0f * dot(direction, normal)) * normal - direction;
}

/// Normalised, energy-conserving Phong lobe (Lafortune and Willems 1994): BSDF times cosine for a reflectance of 1, in
/// local coordinates.
REALCAM_INLINE float phong_value(Vec3f eye, float shininess, Vec3f light) {
    const float density = phong_pdf({-eye.x, -eye.y, eye.z}, shininess, light);
    return (shininess + 2.0f) / (shininess + 1.0f) * density * light.z;
}

}  // namespace REALCAM_NAMESPACE
