#pragma once
#include "environment.hpp"
#include "light_tree.hpp"
#include "opacity.hpp"

namespace REALCAM_NAMESPACE {

/// Density per steradian of a point on an area light, drawn evenly over it, at this distance and with this cosine
/// between its normal and the way to it.
REALCAM_INLINE float area_light_pdf(float area, float distance_squared, float cosine) {
    return distance_squared / (area * cosine);
}

/// What an area light sends from the point with these barycentric coordinates.
template <SceneKind scene_kind>
REALCAM_INLINE Color emitted_radiance(const SceneView& scene, const AreaLight& light, float along_u, float along_v) {
    if constexpr (scene_kind == SceneKind::plain) return light.radiance;
    const MeshView& mesh = mesh_of(scene, light.instance);
    const Triangle& triangle = mesh.triangles[light.triangle];
    const Hit place = {0.0f, light.triangle, along_u, along_v, light.instance};
    Color radiance = light.radiance;
    const TextureReference& map = mesh.materials[triangle.material].emission_texture;
    if (map.texture >= 0) radiance *= texture_color(mesh, map, surface_uv(mesh, triangle, place).at);
    if constexpr (scene_kind == SceneKind::any) radiance = opacity_at(mesh, triangle, place) * radiance;
    return radiance;
}

/// Where an area light that may move is at a time.
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

/// Where a point light that may move is at a time.
REALCAM_INLINE PointLight point_light_at(const SceneView& scene, const PointLight& stored, float time) {
    PointLight light = stored;
    if (light.moves_with < 0) return light;
    const InstanceView instance = instance_at(scene, static_cast<std::uint32_t>(light.moves_with), time);
    light.position = instance.render_from_object.point(light.position);
    const Vec3f axis = instance.render_from_object.direction(light.axis);
    light.axis = (1.0f / length(axis)) * axis;
    return light;
}

/// A point on an area light, drawn evenly.
template <SceneKind scene_kind>
REALCAM_INLINE LightSample sample_area_light(const SceneView& scene, const AreaLight& light, Vec3f position, Vec2f u) {
    const float root = std::sqrt(u.x), along_u = root * (1.0f - u.y), along_v = root * u.y;
    const Vec3f on_light = light.corner + along_u * light.edge_u + along_v * light.edge_v;
    const Vec3f to_light = on_light - position;
    const float squared = dot(to_light, to_light);
    const float distance = std::sqrt(squared);
    const Vec3f direction = (1.0f / distance) * to_light;
    const float on_side = -dot(direction, light.normal);
    const float cosine = scene_kind != SceneKind::plain && light.is_two_sided ? std::fabs(on_side) : on_side;
    // Also where the point lies on the light, and the direction has no value.
    if (!(cosine > 0.0f)) return {light.normal, distance, 1.0f, {0, 0, 0}, kDelta};
    const float reach = 1.0f - (light.margin + kMarginShare * distance) / (cosine * distance);
    const float pdf = area_light_pdf(light.area, squared, cosine);
    return {direction, distance, reach, (1.0f / pdf) * emitted_radiance<scene_kind>(scene, light, along_u, along_v),
            pdf};
}

REALCAM_INLINE LightSample sample_point_light(const PointLight& light, Vec3f position) {
    const Vec3f to_light = light.position - position;
    const float squared = dot(to_light, to_light), distance = std::sqrt(squared);
    if (!(squared > 1e-30f)) return {{0, 1, 0}, distance, 1.0f, {0, 0, 0}, kDelta};
    const float inverse = 1.0f / distance,
                reach = 1.0f - kMarginShare * (largest_coordinate(light.position) * inverse + 1.0f);
    const Vec3f direction = inverse * to_light;
    const float fading = light.cos_offset - light.cos_scale * dot(light.axis, direction);
    const float share = select(fading < 0.0f, 0.0f, select(fading < 1.0f, fading, 1.0f));
    return {direction, distance, reach, (share * share / squared) * light.intensity, kDelta};
}

/// Probabilities of the kinds of light at a receiver: about the illuminance that each can bring there if nothing stands
/// in between, and for one half alike, because much may stand in between.
class LightKinds {
public:
    REALCAM_INLINE LightKinds(const SceneView& scene, LightReceiver receiver)
        : LightKinds(scene, receiver, [&] { return light_importance(scene.light_nodes[0], receiver); }) {}

    /// `local()`: the importance of the tree's root for the receiver, for those who have found it for many at once.
    template <class Local>
    REALCAM_INLINE LightKinds(const SceneView& scene, LightReceiver receiver, Local&& local)
        : scene_(scene), receiver_(receiver) {
        const int count = count_of(scene);
        const auto kinds = static_cast<float>(count);
        local_ = environment_ = scale_ = 0.0f;
        even_ = 1.0f;
        if (count < 2) return;
        local_ = has_local() ? local() : 0.0f;
        environment_ = scene.has_environment ? 3.141592654f * scene.environment.mean_luminance : 0.0f;
        float sum = local_ + environment_;
        for (int i = 0; i < scene.sun_count; ++i) sum += sun(i);
        // No estimate, or one that float cannot hold: all alike.
        const bool is_useful = sum > 0.0f && sum < 1e30f;
        even_ = kinds > 0.0f ? (is_useful ? kEven : 1.0f) / kinds : 0.0f;
        scale_ = is_useful ? (1.0f - kEven) / sum : 0.0f;
    }

    /// With fewer than two nobody asks for importances.
    REALCAM_INLINE static int count_of(const SceneView& scene) {
        return (scene.light_node_count > 0) + scene.sun_count + scene.has_environment;
    }

    REALCAM_INLINE bool has_local() const { return scene_.light_node_count > 0; }
    /// Of point and area lights, together.
    REALCAM_INLINE float local_probability() const { return has_local() ? scaled(local_) : 0.0f; }
    REALCAM_INLINE float environment_probability() const {
        return scene_.has_environment ? scaled(environment_) : 0.0f;
    }
    REALCAM_INLINE float sun_probability(int i) const { return scaled(sun(i)); }

private:
    static constexpr float kEven = 0.5f;

    REALCAM_INLINE float sun(int i) const {
        const Vec3f n = receiver_.normal;
        const float cosine = dot(n, n) > 0.0f ? -dot(n, scene_.suns[i].direction) : 1.0f;
        return cosine > 0.0f ? cosine * luminance(scene_.suns[i].illuminance) : 0.0f;
    }
    REALCAM_INLINE float scaled(float importance) const { return scale_ > 0.0f ? even_ + scale_ * importance : even_; }

    const SceneView& scene_;
    LightReceiver receiver_;
    float local_, environment_, even_, scale_;
};

/// Density per steradian of sample_light in a direction in which the environment is seen.
REALCAM_INLINE float environment_light_pdf(const SceneView& scene, LightReceiver receiver, Vec3f direction) {
    return LightKinds(scene, receiver).environment_probability() *
           environment_pdf(scene.environment, receiver.normal, direction);
}

/// Likewise in a direction in which an area light is met, at this distance and with this cosine at it.
template <SceneKind scene_kind>
REALCAM_INLINE float emitter_light_pdf(const SceneView& scene, LightReceiver receiver, std::int32_t area_light,
                                       float distance, float cosine) {
    const AreaLight& light = scene.areas[area_light];
    float area = light.area;
    if constexpr (scene_kind == SceneKind::any) area = area_light_at(scene, light, receiver.time).area;
    return LightKinds(scene, receiver).local_probability() *
           light_probability(scene, receiver, scene.point_count + area_light) *
           area_light_pdf(area, distance * distance, cosine);
}

/// The area light that a hit on an emitting triangle is on.
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

/// Chooses one light, and a place on it. One pair of numbers does both, so that what is even over a pixel's samples is
/// even over each light. `seed` as in choose_light.
template <SceneKind scene_kind>
REALCAM_INLINE LightSample sample_light(const SceneView& scene, LightReceiver receiver, const LightKinds& kinds,
                                        Vec2f u, std::uint32_t seed) {
    LightSample sample{{0, 1, 0}, kFarAway, 1.0f, {0, 0, 0}, kDelta};
    float probability = kinds.local_probability();
    const auto rescale = [&] {
        const float fresh = u.x / probability;
        u.x = fresh < 0x1.fffffep-1f ? fresh : 0x1.fffffep-1f;
    };
    if (u.x < probability) {
        rescale();
        const LightChoice chosen = choose_light(scene, receiver, u.x, seed);
        u.x = chosen.fresh;
        probability *= chosen.probability;
        const std::int32_t area = chosen.light - scene.point_count;
        if constexpr (scene_kind == SceneKind::any) {
            sample = area < 0
                         ? sample_point_light(point_light_at(scene, scene.points[chosen.light], receiver.time),
                                              receiver.position)
                         : sample_area_light<scene_kind>(scene, area_light_at(scene, scene.areas[area], receiver.time),
                                                         receiver.position, u);
        } else {
            sample = area < 0 ? sample_point_light(scene.points[chosen.light], receiver.position)
                              : sample_area_light<scene_kind>(scene, scene.areas[area], receiver.position, u);
        }
    } else {
        u.x -= probability;
        probability = kinds.environment_probability();
        if (u.x < probability) {
            rescale();
            sample = sample_environment(scene.environment, receiver.normal, u);
        } else {
            for (int i = 0; i < scene.sun_count; ++i) {
                u.x -= probability;
                probability = kinds.sun_probability(i);
                // The last one also where roundings have left nothing to it.
                if (u.x < probability || i + 1 == scene.sun_count) {
                    sample.direction = -scene.suns[i].direction;
                    sample.irradiance = scene.suns[i].illuminance;
                    break;
                }
            }
        }
    }
    if (!(probability > 0.0f)) return sample;
    // One over the squared distance has no bound. Lights end at 1e30; what a narrow lobe and the film's sums make of
    // this is still finite.
    const auto bounded = [](float v) { return v < 1e28f ? v : 1e28f; };
    const Color all = (1.0f / probability) * sample.irradiance;
    sample.irradiance = {bounded(all.r), bounded(all.g), bounded(all.b)};
    sample.pdf *= probability;
    return sample;
}

template <SceneKind scene_kind>
REALCAM_INLINE LightSample sample_light(const SceneView& scene, LightReceiver receiver, Vec2f u, std::uint32_t seed) {
    return sample_light<scene_kind>(scene, receiver, LightKinds(scene, receiver), u, seed);
}

}  // namespace REALCAM_NAMESPACE
