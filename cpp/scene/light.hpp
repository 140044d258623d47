#pragma once
#include "environment.hpp"
#include "surface_point.hpp"

namespace REALCAM_NAMESPACE {

/// Density of sample_area_light per steradian, of a point on a light at this distance and with this cosine between its
/// normal and the way to it.
REALCAM_INLINE float area_light_pdf(const AreaLight& light, float distance_squared, float cosine) {
    return light.density * distance_squared / cosine;
}

REALCAM_INLINE LightSample sample_area_light(const SceneView& scene, Vec3f position, Vec2f u) {
    const CdfChoice choice = choose_from_cdf(scene.area_cdf, scene.area_count, u.x);
    const AreaLight& light = scene.areas[choice.index];
    const float root = std::sqrt(choice.fresh);
    const Vec3f on_light = light.corner + (root * (1.0f - u.y)) * light.edge_u + (root * u.y) * light.edge_v;
    const Vec3f to_light = on_light - position;
    const float squared = dot(to_light, to_light);
    const float distance = std::sqrt(squared);
    const Vec3f direction = (1.0f / distance) * to_light;
    const float cosine = -dot(direction, light.normal);
    // Also where the point lies on the light, and the direction has no value.
    if (!(cosine > 0.0f)) return {light.normal, distance, 1.0f, {0, 0, 0}};
    const float reach = 1.0f - (light.margin + kMarginShare * distance) / (cosine * distance);
    return {direction, distance, reach, (1.0f / area_light_pdf(light, squared, cosine)) * light.radiance};
}

REALCAM_INLINE LightSample sample_point_light(const SceneView& scene, Vec3f position, int index) {
    const Vec3f light = scene.points[index].position, to_light = light - position;
    const float squared = dot(to_light, to_light), distance = std::sqrt(squared);
    if (!(squared > 1e-30f)) return {{0, 1, 0}, distance, 1.0f, {0, 0, 0}};
    const float inverse = 1.0f / distance, reach = 1.0f - kMarginShare * (largest_coordinate(light) * inverse + 1.0f);
    return {inverse * to_light, distance, reach, (1.0f / squared) * scene.points[index].intensity};
}

/// Kinds of light, of which one is chosen with equal probability: every point light and every sun, all area lights
/// together, the environment.
REALCAM_INLINE int light_kinds(const SceneView& scene) {
    return scene.point_count + scene.sun_count + (scene.area_count > 0) + scene.has_environment;
}

/// A kind of light, in the order of light_kinds.
struct LightChoice {
    int kind;
    float pdf;
    float fresh;  ///< a random number made of what the choice left over
};

REALCAM_INLINE LightChoice choose_light(int kinds, float u) {
    const float scaled = u * static_cast<float>(kinds);
    int kind = static_cast<int>(scaled);
    kind = select(kind < kinds, kind, kinds - 1);
    const float fresh = scaled - static_cast<float>(kind);
    return {kind, 1.0f / static_cast<float>(kinds), select(fresh < 1.0f, fresh, 0x1.fffffep-1f)};
}

/// Chooses one kind of light with equal probability (light_kinds), and of area lights a triangle and of an environment
/// image a pixel by their tables (light_tables.hpp). A constant environment is sampled by the cosine at the point.
REALCAM_INLINE LightSample sample_light(const SceneView& scene, const SurfacePoint& point, Vec2f u) {
    const int kinds = light_kinds(scene);
    if (kinds == 0) return {{0, 1, 0}, kFarAway, 1.0f, {0, 0, 0}};
    const LightChoice choice = choose_light(kinds, u.x);
    int kind = choice.kind;
    u.x = choice.fresh;
    LightSample sample;
    if (kind < scene.point_count) {
        sample = sample_point_light(scene, point.position, kind);
    } else if ((kind -= scene.point_count) < scene.sun_count) {
        sample = {-scene.suns[kind].direction, kFarAway, 1.0f, scene.suns[kind].illuminance};
    } else if ((kind -= scene.sun_count) == 0 && scene.area_count > 0) {
        sample = sample_area_light(scene, point.position, u);
    } else if (scene.environment.pixels) {
        sample = sample_environment_image(scene.environment, u);
    } else {
        const Vec3f direction = sample_cosine(point.normal, u);
        const float pdf = cosine_pdf(point.normal, direction);
        sample = {direction, kFarAway, 1.0f, (pdf > 0.0f ? 1.0f / pdf : 0.0f) * scene.environment.constant};
    }
    // One over the squared distance has no bound. Lights end at 1e30; what a narrow lobe and the film's sums make of
    // this is still finite.
    const auto bounded = [](float v) { return v < 1e28f ? v : 1e28f; };
    const Vec3f all = (1.0f / choice.pdf) * sample.irradiance;
    sample.irradiance = {bounded(all.x), bounded(all.y), bounded(all.z)};
    return sample;
}

}  // namespace REALCAM_NAMESPACE
