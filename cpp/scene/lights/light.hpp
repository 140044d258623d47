#pragma once
#include "../../math/spherical_triangle.hpp"
#include "../geometry/opacity.hpp"
#include "../materials/scattering.hpp"
#include "environment.hpp"
#include "light_tree.hpp"

namespace REALCAM_NAMESPACE {

// Light sampling: choice of a light, a point on it or a direction to it, and the densities for multiple importance
// sampling. At a receiver, the kinds of light are the point and area lights together (the light tree), each sun, and
// the environment.

/// Solid-angle density of a point sampled uniformly by area on an area light, at this distance; `cosine`: between the
/// light's normal and the direction to the receiver.
REALCAM_INLINE float area_light_pdf(float area, float distance_squared, float cosine) {
    return distance_squared / (area * cosine);
}

/// Radiance, cd/m^2, that an area light emits at barycentric coordinates (along_u, along_v).
template <SceneKind scene_kind>
REALCAM_INLINE Color emitted_radiance(const SceneView& scene, const AreaLight& light, float along_u, float along_v) {
    if constexpr (scene_kind == SceneKind::plain) return light.radiance;
    const MeshView& mesh = mesh_of(scene, light.instance);
    const Triangle& triangle = mesh.triangles[light.triangle];
    const Hit hit = {0.0f, light.triangle, along_u, along_v, light.instance};
    Color radiance = light.radiance;
    const TextureReference& map = mesh.materials[triangle.material].emission_texture;
    if (mesh.materials[triangle.material].vertex_emission) radiance *= vertex_color(mesh, triangle, hit);
    if (map.texture >= 0) radiance *= texture_color(mesh, map, surface_uv(mesh, triangle, hit, map).at);
    if constexpr (scene_kind == SceneKind::any) radiance = opacity_at(mesh, triangle, hit) * radiance;
    return radiance;
}

/// Returns an area light, which may move, at a time of the exposure.
REALCAM_INLINE AreaLight area_light_at(const SceneView& scene, const AreaLight& stored, float time) {
    AreaLight light = stored;
    if (light.instance == kNoInstance || scene.instances[light.instance].key_count == 0) return light;
    const InstanceView instance = instance_at(scene, light.instance, time);
    const MeshView& object = scene.objects[instance.object];
    const std::uint32_t* corners = object.triangles[light.triangle].vertices;
    const TrianglePlane& plane = object.planes[light.triangle];
    const Vec3f corner = object.positions[corners[0]];
    light.corner = instance.render_from_object.point(corner);
    light.edge_u = instance.render_from_object.direction(object.positions[corners[1]] - corner);
    light.edge_v = instance.render_from_object.direction(object.positions[corners[2]] - corner);
    light.area = 0.5f * length(cross(light.edge_u, light.edge_v));
    const Vec3f normal = instance.object_from_render.normal_of(plane.normal);
    const float stretch = 1.0f / length(normal);
    light.normal = stretch * normal;
    light.margin = instance_margin(instance, plane.margin, plane.normal, stretch, light.corner);
    return light;
}

/// Returns the area light of this index at a time of the exposure; only scenes of SceneKind::any have moving ones.
template <SceneKind scene_kind>
REALCAM_INLINE AreaLight area_light_at(const SceneView& scene, std::int32_t index, float time) {
    if constexpr (scene_kind == SceneKind::any) return area_light_at(scene, scene.areas[index], time);
    return scene.areas[index];
}

/// Returns a point light, which may move, at a time of the exposure.
REALCAM_INLINE PointLight point_light_at(const SceneView& scene, const PointLight& stored, float time) {
    PointLight light = stored;
    if (light.moves_with < 0) return light;
    const InstanceView instance = instance_at(scene, static_cast<std::uint32_t>(light.moves_with), time);
    light.position = instance.render_from_object.point(light.position);
    const Vec3f axis = instance.render_from_object.direction(light.axis);
    light.axis = (1.0f / length(axis)) * axis;
    return light;
}

/// Direction and distance from a position to a point on an area light.
struct DirectionToLight {
    Vec3f direction;  ///< unit
    float distance, reach;  ///< see LightSample
    /// Cosine between the light's normal and the direction to the position; positive if the light emits towards it.
    float cosine;
    float pdf;  ///< solid-angle density of a point sampled uniformly by area
};

/// Returns direction and distance from a position to a point on a light. `u`: barycentric coordinates of the point.
/// Free of branches, so that loops vectorise. If the position lies on the light, the cosine is NaN.
REALCAM_INLINE DirectionToLight direction_to_light(const AreaLight& light, bool on_both_sides, Vec3f position,
                                                   Vec2f u) {
    const Vec3f to_light = light.corner + u.x * light.edge_u + u.y * light.edge_v - position;
    const float squared = dot(to_light, to_light), distance = std::sqrt(squared);
    const Vec3f direction = (1.0f / distance) * to_light;
    const float front_cosine = -dot(direction, light.normal);
    const float cosine = select(on_both_sides, std::fabs(front_cosine), front_cosine);
    const float reach = 1.0f - (light.margin + kMarginShare * distance) / (cosine * distance);
    return {direction, distance, reach, cosine, area_light_pdf(light.area, squared, cosine)};
}

/// Barycentric coordinates of a point sampled uniformly on a triangle.
REALCAM_INLINE Vec2f sample_triangle(Vec2f u) {
    const float root = std::sqrt(u.x);
    return {root * (1.0f - u.y), root * u.y};
}

/// True if points on an area light are sampled uniformly by solid angle, because sampled by area, points close to the
/// receiver would have unbounded weights. True up to a distance of about 1.2 times the light's size, so that for lights
/// sampled by area the nearest corner is at least a third of the centroid's distance away.
REALCAM_INLINE bool is_near(const AreaLight& light, Vec3f position) {
    const Vec3f to_middle = light.corner + (1.0f / 3.0f) * (light.edge_u + light.edge_v) - position;
    // 1.5 times the sum of the squared distances of the corners from the centroid.
    const float size2 =
        dot(light.edge_u, light.edge_u) + dot(light.edge_v, light.edge_v) - dot(light.edge_u, light.edge_v);
    return dot(to_middle, to_middle) < size2;
}

/// Point sampled uniformly by solid angle, in barycentric coordinates.
struct SolidAngleSample {
    Vec2f at;  ///< barycentric coordinates
    float solid_angle;  ///< solid angle of the whole light, in steradians
};

/// Samples a triangle with corners a, b, c, seen from the origin, uniformly by solid angle. `double_area`: twice its
/// area; `height`: distance of its plane from the origin. A function call on GPUs, because few receivers are near a
/// light.
REALCAM_ONE_COPY SolidAngleSample sample_spherical_triangle(Vec3f a, Vec3f b, Vec3f c, float double_area, float height,
                                                            Vec2f u) {
    const SphericalTriangle triangle(a, b, c, double_area, height);
    return {triangle.sample(u), triangle.solid_angle};
}

/// Samples an area light uniformly by solid angle.
REALCAM_INLINE SolidAngleSample sample_near(const AreaLight& light, Vec3f position, Vec2f u) {
    const Vec3f corner = light.corner - position;
    return sample_spherical_triangle(corner, corner + light.edge_u, corner + light.edge_v, 2.0f * light.area,
                                     std::fabs(dot(corner, light.normal)), u);
}

/// Density of sample_area_light, per steradian, at a point on the light. `distance`, `cosine`: see DirectionToLight.
REALCAM_INLINE float solid_angle_pdf(const AreaLight& light, Vec3f position, float distance, float cosine) {
    return is_near(light, position) ? 1.0f / sample_near(light, position, {0, 0}).solid_angle
                                    : area_light_pdf(light.area, distance * distance, cosine);
}

/// Light sample of a point on an area light, given by barycentric coordinates. Black if the receiver is behind the
/// light.
template <SceneKind scene_kind>
REALCAM_INLINE LightSample light_from(const SceneView& scene, const AreaLight& light, const DirectionToLight& to_light,
                                      Vec2f point) {
    if (!(to_light.cosine > 0.0f)) return {light.normal, to_light.distance, 1.0f, {0, 0, 0}, kDelta};
    return {to_light.direction, to_light.distance, to_light.reach,
            (1.0f / to_light.pdf) * emitted_radiance<scene_kind>(scene, light, point.x, point.y), to_light.pdf};
}

/// True if the light emits on both sides; in plain scenes none does.
template <SceneKind scene_kind>
REALCAM_INLINE bool shines_on_both_sides(const AreaLight& light) {
    return scene_kind != SceneKind::plain && light.is_two_sided != 0;
}

/// Samples an area light uniformly by area.
template <SceneKind scene_kind>
REALCAM_INLINE LightSample sample_area(const SceneView& scene, const AreaLight& light, Vec3f position, Vec2f u) {
    const Vec2f point = sample_triangle(u);
    return light_from<scene_kind>(
        scene, light, direction_to_light(light, shines_on_both_sides<scene_kind>(light), position, point), point);
}

/// Samples an area light with the density solid_angle_pdf.
template <SceneKind scene_kind>
REALCAM_INLINE LightSample sample_area_light(const SceneView& scene, const AreaLight& light, Vec3f position, Vec2f u) {
    if (!is_near(light, position)) return sample_area<scene_kind>(scene, light, position, u);
    const SolidAngleSample sample = sample_near(light, position, u);
    DirectionToLight to_light = direction_to_light(light, shines_on_both_sides<scene_kind>(light), position, sample.at);
    to_light.pdf = 1.0f / sample.solid_angle;
    return light_from<scene_kind>(scene, light, to_light, sample.at);
}

/// Light sample of a point light for a receiver at a position. Black if they coincide.
REALCAM_INLINE LightSample sample_point_light(const PointLight& light, Vec3f position) {
    const Vec3f to_light = light.position - position;
    const float squared = dot(to_light, to_light), distance = std::sqrt(squared);
    if (!(squared > 1e-30f)) return {{0, 1, 0}, distance, 1.0f, {0, 0, 0}, kDelta};
    const float inverse = 1.0f / distance,
                reach = 1.0f - kMarginShare * (largest_coordinate(light.position) * inverse + 1.0f);
    const Vec3f direction = inverse * to_light;
    const float falloff = light.cos_offset - light.cos_scale * dot(light.axis, direction);
    const float clamped = select(falloff < 0.0f, 0.0f, select(falloff < 1.0f, falloff, 1.0f));
    return {direction, distance, reach, (clamped * clamped / squared) * light.intensity, kDelta};
}

/// Probability of choosing a kind of light: `even`, which is the same for all kinds, plus `scale` times its importance.
struct KindProbabilities {
    float even, scale;

    REALCAM_INLINE float probability(float importance) const {
        return select(scale > 0.0f, even + scale * importance, even);
    }
};

/// Returns the probabilities that sum to 1. `count`: number of kinds of light, at least one; `sum`: sum of their
/// importances.
REALCAM_INLINE KindProbabilities kind_probabilities(float count, float sum) {
    constexpr float kUniform = 0.5f;  // total probability of the uniform part
    // Falls back to the uniform distribution if the estimate is 0 or overflows.
    const bool is_useful = (sum > 0.0f) & (sum < 1e30f);
    // Never divides by 0, even if the result is discarded: a GPU takes a slow path of many instructions for that.
    return {select(is_useful, kUniform, 1.0f) / count,
            select(is_useful, (1.0f - kUniform) / select(is_useful, sum, 1.0f), 0.0f)};
}

/// Importance of the environment: the illuminance, in lux, of a surface with half of its directions above it, at the
/// mean luminance. 0 without an environment.
REALCAM_INLINE float environment_importance(const SceneView& scene) {
    return scene.has_environment ? 3.141592654f * scene.environment.mean_luminance : 0.0f;
}

/// Importance of a sun: the unoccluded illuminance in lux. `normal`: of the receiver; zero: all directions.
REALCAM_INLINE float sun_importance(const SunLight& sun, Vec3f normal) {
    const float cosine = select(dot(normal, normal) > 0.0f, -dot(normal, sun.direction), 1.0f);
    return select(cosine > 0.0f, cosine * luminance(sun.illuminance), 0.0f);
}

/// Light samples at a surface: one of a chosen light, and one of the environment if it is sampled separately.
inline constexpr int kLightSampleCount = 2;

/// Estimated fraction of a receiver's light from which on the environment gets a sample of its own.
inline constexpr float kSeparateFraction = 0.1f;

/// Probabilities of the kinds of light at a receiver. Half of the probability is proportional to the estimated
/// unoccluded illuminance of each kind; the other half is uniform, because the brightest kind may be occluded.
struct LightKinds {
    KindProbabilities shares;  ///< from which the probabilities of the suns are computed
    float local_probability;  ///< all point and area lights together
    float environment_probability;  ///< 0 if it is not one of the choices
    bool environment_is_separate;  ///< it has a sample of its own and is not one of the choices of the other sample

    /// Probability that one of the two light samples is taken from the environment.
    REALCAM_INLINE float environment_chance() const {
        return select(environment_is_separate, 1.0f, environment_probability);
    }

    /// Probability of one sun. `normal`: of the receiver.
    REALCAM_INLINE float sun_probability(const SunLight& sun, Vec3f normal) const {
        return shares.probability(select(shares.scale > 0.0f, sun_importance(sun, normal), 0.0f));
    }
};

/// Number of kinds of light in the scene: point and area lights as one, each sun, and the environment.
REALCAM_INLINE int count_light_kinds(const SceneView& scene) {
    return (scene.light_node_count > 0) + scene.sun_count + scene.has_environment;
}

/// Returns the strategy for the environment at a surface. `goes_on`: true if the path continues with a BSDF sample;
/// `is_first`: true at the first surface of a path.
REALCAM_INLINE SkySampling sky_sampling(const SceneView& scene, bool goes_on, bool is_first) {
    if (scene.light_node_count + scene.sun_count == 0) return SkySampling::chosen;
    // The BSDF sample reaches a constant environment with about the density of a light sample.
    if (goes_on) return scene.environment.pixels ? SkySampling::chosen : SkySampling::bsdf_only;
    return is_first ? SkySampling::apart : SkySampling::chosen;
}

/// True if the scene has a light for the light sample of this index, 0 or 1.
REALCAM_INLINE bool has_light(const SceneView& scene, SkySampling sky, int sample_index) {
    if (sample_index == 1) return sky == SkySampling::apart && scene.has_environment;
    return scene.light_node_count + scene.sun_count > 0 || scene.has_environment;
}

/// Returns the probabilities of the kinds of light. `local`, `suns`: importances of all point and area lights, and of
/// all suns; 0 if there is only one kind. Free of branches, so that loops over receivers vectorise.
REALCAM_INLINE LightKinds light_kinds(const SceneView& scene, SkySampling sampling, float local, float suns) {
    const int count = count_light_kinds(scene);
    const float sky = count > 1 ? environment_importance(scene) : 0.0f, others = local + suns;
    const bool is_apart = (sampling == SkySampling::apart) & scene.has_environment &
                          (sky >= kSeparateFraction * (sky + others)),
               is_chosen = scene.has_environment & !is_apart & (sampling != SkySampling::bsdf_only);
    const bool is_left_out = scene.has_environment & !is_chosen;
    const KindProbabilities shares = kind_probabilities(static_cast<float>(count) - select(is_left_out, 1.0f, 0.0f),
                                                        select(is_chosen, others + sky, others));
    return {shares, scene.light_node_count > 0 ? shares.probability(local) : 0.0f,
            select(is_chosen, shares.probability(sky), 0.0f), is_apart};
}

/// Importances of all point and area lights together, and of all suns together.
struct LightImportances {
    float local = 0.0f, suns = 0.0f;
};

/// Importances at a receiver.
REALCAM_ONE_COPY LightImportances light_importances(const SceneView& scene, LightReceiver receiver) {
    LightImportances importances;
    if (scene.light_node_count > 0) importances.local = max_illuminance(scene.light_nodes[0], receiver);
    for (int i = 0; i < scene.sun_count; ++i) importances.suns += sun_importance(scene.suns[i], receiver.normal);
    return importances;
}

/// Returns the probabilities of the kinds of light at a receiver.
REALCAM_INLINE LightKinds light_kinds(const SceneView& scene, SkySampling sampling, LightReceiver receiver) {
    LightImportances importances;
    if (count_light_kinds(scene) > 1) importances = light_importances(scene, receiver);
    return light_kinds(scene, sampling, importances.local, importances.suns);
}

/// Solid-angle density of sample_light in a direction in which the environment is visible. At most one of the two
/// samples can have that direction; which one depends only on the receiver.
REALCAM_INLINE float environment_light_pdf(const SceneView& scene, SkySampling sampling, LightReceiver receiver,
                                           Vec3f direction) {
    return light_kinds(scene, sampling, receiver).environment_chance() *
           environment_pdf(scene.environment, receiver.normal, direction);
}

/// Solid-angle density of sample_light in a direction in which an area light is hit, at this distance and with this
/// cosine at the light. `area_light`: index of the light.
template <SceneKind scene_kind>
REALCAM_INLINE float emitter_light_pdf(const SceneView& scene, SkySampling sampling, LightReceiver receiver,
                                       std::int32_t area_light, float distance, float cosine) {
    const AreaLight light = area_light_at<scene_kind>(scene, area_light, receiver.time);
    return light_kinds(scene, sampling, receiver).local_probability *
           light_probability(scene, receiver, scene.point_count + area_light) *
           solid_angle_pdf(light, receiver.position, distance, cosine);
}

/// Index of the area light of a hit on an emitting triangle.
/// The triangle must be one of its mesh's emitters, which are sorted.
REALCAM_INLINE std::int32_t area_light_of(const SceneView& scene, Hit hit) {
    const bool is_static = hit.instance == kNoInstance;
    const MeshView& mesh = mesh_of(scene, hit.instance);
    std::int32_t first = 0, last = mesh.emitter_count;
    while (first + 1 < last) {
        const std::int32_t middle = (first + last) / 2;
        (mesh.emitters[middle] <= hit.triangle ? first : last) = middle;
    }
    return first + (is_static ? 0 : scene.instances[hit.instance].first_area);
}

enum class LightKind : std::int32_t { point, area, environment, sun };

/// Chosen light.
struct LightPick {
    LightKind kind;
    std::int32_t index;  ///< among the lights of its kind
    float probability;  ///< with which it was chosen; 0: no light was chosen
    Vec2f u;  ///< random numbers for sampling it
};

/// Chooses one light. A single pair of random numbers chooses the light and the point on it, so that stratification
/// over a pixel's samples carries over to each light. `sample_index`: 0 or 1 (kLightSampleCount). `choose(u)`: chooses
/// one of the point and area lights and returns a LightChoice, like choose_light.
template <class Choose>
REALCAM_INLINE LightPick pick_light_by(const SceneView& scene, LightReceiver receiver, const LightKinds& kinds,
                                       int sample_index, Vec2f u, const Choose& choose) {
    if (sample_index == 1) return {LightKind::environment, 0, kinds.environment_is_separate ? 1.0f : 0.0f, u};
    float probability = kinds.local_probability;
    if (u.x < probability) {
        const LightChoice chosen = choose(remapped_random(u.x, probability));
        const std::int32_t area = chosen.light - scene.point_count;
        return {area < 0 ? LightKind::point : LightKind::area,
                area < 0 ? chosen.light : area,
                probability * chosen.probability,
                {chosen.fresh, u.y}};
    }
    u.x -= probability;
    probability = kinds.environment_probability;
    if (u.x < probability) return {LightKind::environment, 0, probability, {remapped_random(u.x, probability), u.y}};
    for (int i = 0; i < scene.sun_count; ++i) {
        u.x -= probability;
        probability = kinds.sun_probability(scene.suns[i], receiver.normal);
        // The last sun also takes the remainder due to rounding.
        if (u.x < probability || i + 1 == scene.sun_count) return {LightKind::sun, i, probability, u};
    }
    return {LightKind::environment, 0, 0.0f, u};
}

/// Chooses one light, point and area lights by choose_light. `sample_index`: see pick_light_by; `seed`: see
/// choose_light.
REALCAM_INLINE LightPick pick_light(const SceneView& scene, LightReceiver receiver, const LightKinds& kinds,
                                    int sample_index, Vec2f u, std::uint32_t seed) {
    return pick_light_by(scene, receiver, kinds, sample_index, u,
                         [&](float tree_u) { return choose_light(scene, receiver, tree_u, seed); });
}

/// Clamps each channel to 1e28. 1 / distance^2 is unbounded, and intensities reach 1e30 cd. With this bound a narrow
/// lobe's value and the film's sums stay finite.
REALCAM_INLINE Color bounded_light(Color c) {
    const auto bounded = [](float v) { return select(v < 1e28f, v, 1e28f); };
    return {bounded(c.r), bounded(c.g), bounded(c.b)};
}

/// Samples the chosen light as if it were the only one.
template <SceneKind scene_kind>
REALCAM_INLINE LightSample sample_picked(const SceneView& scene, LightReceiver receiver, const LightPick& pick) {
    switch (pick.kind) {
        case LightKind::point:
            if constexpr (scene_kind == SceneKind::any)
                return sample_point_light(point_light_at(scene, scene.points[pick.index], receiver.time),
                                          receiver.position);
            return sample_point_light(scene.points[pick.index], receiver.position);
        case LightKind::area:
            return sample_area_light<scene_kind>(scene, area_light_at<scene_kind>(scene, pick.index, receiver.time),
                                                 receiver.position, pick.u);
        case LightKind::environment: return sample_environment(scene.environment, receiver.normal, pick.u);
        case LightKind::sun: break;
    }
    const SunLight& sun = scene.suns[pick.index];
    return {-sun.direction, kFarAway, 1.0f, sun.illuminance, kDelta};
}

/// Chooses one light for the light sample of this index, for which has_light must hold, and samples it. Black if no
/// light was chosen.
template <SceneKind scene_kind>
REALCAM_INLINE LightSample sample_light(const SceneView& scene, SkySampling sampling, LightReceiver receiver,
                                        int sample_index, Vec2f u, std::uint32_t seed) {
    const LightPick pick = pick_light(scene, receiver, light_kinds(scene, sampling, receiver), sample_index, u, seed);
    if (!(pick.probability > 0.0f)) return {{0, 1, 0}, kFarAway, 1.0f, {0, 0, 0}, kDelta};
    LightSample sample = sample_picked<scene_kind>(scene, receiver, pick);
    sample.irradiance = bounded_light((1.0f / pick.probability) * sample.irradiance);
    sample.pdf *= pick.probability;
    return sample;
}

}  // namespace REALCAM_NAMESPACE
