#pragma once
#include "light.hpp"

namespace REALCAM_NAMESPACE {

REALCAM_INLINE Vec3f mirrored_at(Vec3f normal, Vec3f direction) {
    return (2.0f * dot(direction, normal)) * normal - direction;
}

/// Reflectance per steradian: Lambert, and Phong's lobe in its normalised form (Lafortune and Willems 1994), so that no
/// surface reflects more than it gets.
REALCAM_INLINE Vec3f reflectance(const SurfacePoint& point, Vec3f to_eye, Vec3f to_light) {
    Vec3f value = 0.3183098862f * point.diffuse;
    if (point.specular.x + point.specular.y + point.specular.z > 0) {
        const float n = point.shininess;
        const float lobe = phong_pdf(mirrored_at(point.normal, to_eye), n, to_light);
        value += ((n + 2.0f) / (n + 1.0f) * lobe) * point.specular;
    }
    return value;
}

/// Radiance that a light sample sends to the eye if nothing stands in between.
REALCAM_INLINE Vec3f lit_radiance(const SurfacePoint& point, Vec3f to_eye, const LightSample& light) {
    const float cosine = dot(point.normal, light.direction);
    const bool front = cosine > 0 && dot(point.geometric_normal, light.direction) > 0;
    if (!front) return {0, 0, 0};
    return cosine * (reflectance(point, to_eye, light.direction) * light.irradiance);
}

/// A scattered direction and the factor by which it dims the path.
struct Scatter {
    Vec3f direction;
    Vec3f factor;  ///< 0: the path ends
};

/// Probability with which scatter chooses the diffuse lobe: by the largest reflectance of each.
REALCAM_INLINE float diffuse_share(const SurfacePoint& point) {
    const auto largest = [](Vec3f c) { return c.x > c.y ? (c.x > c.z ? c.x : c.z) : (c.y > c.z ? c.y : c.z); };
    const float diffuse = largest(point.diffuse), specular = largest(point.specular);
    return diffuse > 0 ? diffuse / (diffuse + specular) : 0.0f;
}

/// Density of scatter's directions, per steradian.
REALCAM_INLINE float scatter_pdf(const SurfacePoint& point, Vec3f to_eye, Vec3f direction) {
    const float share = diffuse_share(point);
    const float lobe = phong_pdf(mirrored_at(point.normal, to_eye), point.shininess, direction);
    return share * cosine_pdf(point.normal, direction) + (1.0f - share) * lobe;
}

/// Chooses a lobe, then a direction by its cosine or its power. The factor is the lobe's reflectance times the cosine
/// over the density of both choices, in which all but a few factors cancel.
REALCAM_INLINE Scatter scatter(const SurfacePoint& point, Vec3f to_eye, Vec2f u) {
    const Vec3f all = point.diffuse + point.specular;
    if (!(all.x + all.y + all.z > 0)) return {point.normal, {0, 0, 0}};
    const float share = diffuse_share(point);
    Scatter result;
    if (u.x < share) {
        u.x /= share;
        result.direction = sample_cosine(point.normal, u);
        result.factor = (1.0f / share) * point.diffuse;
    } else {
        u.x = (u.x - share) / (1.0f - share);
        result.direction = sample_phong(mirrored_at(point.normal, to_eye), point.shininess, u);
        const float cosine = dot(result.direction, point.normal);
        const float factor = (point.shininess + 2.0f) / (point.shininess + 1.0f) * cosine / (1.0f - share);
        result.factor = (cosine > 0 ? factor : 0.0f) * point.specular;
    }
    if (!(dot(result.direction, point.geometric_normal) > 0)) result.factor = {0, 0, 0};
    return result;
}

}  // namespace REALCAM_NAMESPACE
