#pragma once
#include "light.hpp"

namespace REALCAM_NAMESPACE {

/// Reflectance per steradian: Lambert, and Phong's lobe in its normalised form (Lafortune and Willems 1994), so that no
/// surface reflects more than it gets.
REALCAM_INLINE Vec3f reflectance(const SurfacePoint& point, Vec3f to_eye, Vec3f to_light) {
    Vec3f value = 0.3183098862f * point.diffuse;
    if (point.specular.x + point.specular.y + point.specular.z > 0) {
        const Vec3f mirrored = (2.0f * dot(to_eye, point.normal)) * point.normal - to_eye;
        const float cosine = dot(mirrored, to_light);
        if (cosine > 0)
            value += ((point.shininess + 2.0f) * 0.1591549431f * std::pow(cosine, point.shininess)) * point.specular;
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

/// Chooses the lobe by its largest reflectance, then a direction by its cosine or its power.
REALCAM_INLINE Scatter scatter(const SurfacePoint& point, Vec3f to_eye, Vec2f u) {
    const auto largest = [](Vec3f c) { return c.x > c.y ? (c.x > c.z ? c.x : c.z) : (c.y > c.z ? c.y : c.z); };
    const float diffuse = largest(point.diffuse), specular = largest(point.specular);
    const float total = diffuse + specular;
    if (!(total > 0)) return {point.normal, {0, 0, 0}};
    const float share = diffuse / total;
    Scatter result;
    if (u.x < share) {
        u.x /= share;
        result.direction = sample_cosine(point.normal, u);
        result.factor = (1.0f / share) * point.diffuse;
    } else {
        u.x = (u.x - share) / (1.0f - share);
        const Vec3f mirrored = (2.0f * dot(to_eye, point.normal)) * point.normal - to_eye;
        Vec3f s, t;
        tangent_frame(mirrored, s, t);
        const float cosine = std::pow(1.0f - u.x, 1.0f / (point.shininess + 1.0f));
        const float radius = std::sqrt(1.0f - cosine * cosine);
        const Vec2f azimuth = cos_sin_of_turn(u.y);
        result.direction = (radius * azimuth.x) * s + (radius * azimuth.y) * t + cosine * mirrored;
        const float at_surface = dot(result.direction, point.normal);
        const float factor = (point.shininess + 2.0f) / (point.shininess + 1.0f) * at_surface / (1.0f - share);
        result.factor = factor * point.specular;
    }
    if (!(dot(result.direction, point.geometric_normal) > 0)) result.factor = {0, 0, 0};
    return result;
}

}  // namespace REALCAM_NAMESPACE
