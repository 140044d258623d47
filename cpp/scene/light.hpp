#pragma once
#include "../math/sincos.hpp"
#include "surface_point.hpp"

namespace REALCAM_NAMESPACE {

/// One light direction at a point: divided by the density, but without the reflectance and the cosine at the point.
struct LightSample {
    Vec3f direction;   ///< unit, towards the light
    float distance;    ///< to the light; infinite for sun and environment
    Vec3f irradiance;  ///< arriving at a right angle, over the density; 0: nothing arrives
};

inline constexpr float kFarAway = 3.0e38f;

/// First index whose cumulative probability exceeds u. cdf has count + 1 values, from 0 to 1.
REALCAM_INLINE int find_in_cdf(const float* cdf, int count, float u) {
    int first = 0, last = count;
    while (first + 1 < last) {
        const int middle = (first + last) / 2;
        if (cdf[middle] <= u) {
            first = middle;
        } else {
            last = middle;
        }
    }
    return first;
}

/// Two unit vectors that make a right-handed frame with n (Duff et al. 2017).
REALCAM_INLINE void tangent_frame(Vec3f n, Vec3f& s, Vec3f& t) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z), b = n.x * n.y * a;
    s = {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x};
    t = {b, sign + n.y * n.y * a, -n.y};
}

/// Direction about n with density cosine / pi.
REALCAM_INLINE Vec3f sample_cosine(Vec3f n, Vec2f u) {
    Vec3f s, t;
    tangent_frame(n, s, t);
    const float radius = std::sqrt(u.x), height = std::sqrt(1.0f - u.x);
    const Vec2f azimuth = cos_sin_of_turn(u.y);
    return (radius * azimuth.x) * s + (radius * azimuth.y) * t + height * n;
}

REALCAM_INLINE Vec3f environment_radiance(const EnvironmentView& environment, Vec3f direction) {
    if (!environment.pixels) return environment.constant;
    const float u = 0.5f + std::atan2(direction.x, -direction.z) * 0.1591549431f;
    const float v =
        std::acos(select(direction.y > 1.0f, 1.0f, select(direction.y < -1.0f, -1.0f, direction.y))) * 0.3183098862f;
    int column = static_cast<int>(u * static_cast<float>(environment.width));
    int row = static_cast<int>(v * static_cast<float>(environment.height));
    column = column < environment.width ? column : environment.width - 1;
    row = row < environment.height ? row : environment.height - 1;
    return environment.pixels[static_cast<std::int64_t>(row) * environment.width + column];
}

/// Chooses a pixel in proportion to its light, and a direction inside it.
REALCAM_INLINE LightSample sample_environment_image(const EnvironmentView& environment, Vec2f u) {
    const int width = environment.width, height = environment.height;
    const int row = find_in_cdf(environment.marginal_cdf, height, u.y);
    const float row_share = environment.marginal_cdf[row + 1] - environment.marginal_cdf[row];
    const float fy = (u.y - environment.marginal_cdf[row]) / row_share;
    const float* conditional = environment.conditional_cdf + static_cast<std::int64_t>(row) * (width + 1);
    const int column = find_in_cdf(conditional, width, u.x);
    const float column_share = conditional[column + 1] - conditional[column];
    const float fx = (u.x - conditional[column]) / column_share;
    const float azimuth = 6.283185307f * ((static_cast<float>(column) + fx) / static_cast<float>(width) - 0.5f);
    const float polar = 3.141592654f * (static_cast<float>(row) + fy) / static_cast<float>(height);
    const float sine = std::sin(polar);
    const float density = row_share * column_share * static_cast<float>(width) * static_cast<float>(height) /
                          (19.7392088f * sine);  // 2 pi^2: the map's area in azimuth and polar angle
    const Vec3f radiance = environment.pixels[static_cast<std::int64_t>(row) * width + column];
    return {
        {sine * std::sin(azimuth), std::cos(polar), -sine * std::cos(azimuth)}, kFarAway, (1.0f / density) * radiance};
}

REALCAM_INLINE LightSample sample_area_light(const SceneView& scene, Vec3f position, Vec2f u) {
    const int index = find_in_cdf(scene.area_cdf, scene.area_count, u.x);
    const AreaLight& light = scene.areas[index];
    const float fresh = (u.x - scene.area_cdf[index]) / (scene.area_cdf[index + 1] - scene.area_cdf[index]);
    const float root = std::sqrt(fresh);
    const Vec3f on_light = light.corner + (root * (1.0f - u.y)) * light.edge_u + (root * u.y) * light.edge_v;
    const Vec3f to_light = on_light - position;
    const float squared = dot(to_light, to_light);
    const float distance = std::sqrt(squared);
    const Vec3f direction = (1.0f / distance) * to_light;
    const float cosine = -dot(direction, light.normal);
    const float factor = cosine > 0 && squared > 0 ? cosine * light.area / (squared * light.probability) : 0.0f;
    return {direction, distance, factor * light.radiance};
}

REALCAM_INLINE LightSample sample_point_light(const SceneView& scene, Vec3f position, int index) {
    const Vec3f to_light = scene.points[index].position - position;
    const float squared = dot(to_light, to_light), distance = std::sqrt(squared);
    return {(1.0f / distance) * to_light, distance, (1.0f / squared) * scene.points[index].intensity};
}

/// Chooses one light: kinds with equal probability (every point light and sun counts as a kind of its own), triangles
/// among the area lights by power.
REALCAM_INLINE LightSample sample_light(const SceneView& scene, const SurfacePoint& point, Vec2f u) {
    const int kinds = scene.point_count + scene.sun_count + (scene.area_count > 0) + scene.has_environment;
    if (kinds == 0) return {{0, 1, 0}, kFarAway, {0, 0, 0}};
    const float scaled = u.x * static_cast<float>(kinds);
    int kind = static_cast<int>(scaled);
    kind = kind < kinds ? kind : kinds - 1;
    u.x = scaled - static_cast<float>(kind);
    LightSample sample;
    if (kind < scene.point_count) {
        sample = sample_point_light(scene, point.position, kind);
    } else if ((kind -= scene.point_count) < scene.sun_count) {
        sample = {-scene.suns[kind].direction, kFarAway, scene.suns[kind].illuminance};
    } else if ((kind -= scene.sun_count) == 0 && scene.area_count > 0) {
        sample = sample_area_light(scene, point.position, u);
    } else if (scene.environment.pixels) {
        sample = sample_environment_image(scene.environment, u);
    } else {
        const Vec3f direction = sample_cosine(point.normal, u);
        const float cosine = dot(direction, point.normal);
        sample = {direction, kFarAway, (cosine > 0 ? 3.141592654f / cosine : 0.0f) * scene.environment.constant};
    }
    sample.irradiance = static_cast<float>(kinds) * sample.irradiance;
    return sample;
}

}  // namespace REALCAM_NAMESPACE
