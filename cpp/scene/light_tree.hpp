#pragma once
#include "../math/random.hpp"
#include "light_sample.hpp"
#include "scene_view.hpp"

namespace REALCAM_NAMESPACE {

// One of many lights is chosen on the way down a tree, at each turn by what the lights of either child may send to the
// receiver at most (Conty Estevez and Kulla 2018).

/// Cosine of the difference of two angles between 0 and pi, or 1 where the second is larger.
REALCAM_INLINE float cosine_of_rest(float cos_a, float cos_b) {
    const float rest = cos_a * cos_b + sqrt_or_zero(1.0f - cos_a * cos_a) * sqrt_or_zero(1.0f - cos_b * cos_b);
    return select(cos_a >= cos_b, 1.0f, rest);
}

/// Without branches, so that it becomes vector code for many receivers. About the illuminance, in lux, that a node's
/// lights can bring to a receiver; 0 where none of them can shine on it.
REALCAM_INLINE float light_importance(const LightNode& node, LightReceiver receiver) {
    const Vec3f middle = 0.5f * (node.low + node.high), half = node.high - middle;
    const Vec3f way = receiver.position - middle;
    const float squared = dot(way, way), radius2 = dot(half, half);
    // Cosine of the angle in which the bounds appear. From inside, lights are in all directions.
    const float cos_bounds = select(squared > radius2, sqrt_or_zero(1.0f - radius2 / squared), -1.0f);
    const float inverse = 1.0f / std::sqrt(select(squared > 1e-30f, squared, 1e-30f));
    const float cos_axis = inverse * dot(node.axis, way);
    const float cos_emitted = cosine_of_rest(cosine_of_rest(cos_axis, node.cos_spread), cos_bounds);
    const float cos_received = cosine_of_rest(-inverse * dot(receiver.normal, way), cos_bounds);
    const float emitted = select(node.is_isotropic != 0, 1.0f, select(cos_emitted > 0.0f, cos_emitted, 0.0f));
    const float received =
        select(dot(receiver.normal, receiver.normal) > 0.0f, select(cos_received > 0.0f, cos_received, 0.0f), 1.0f);
    return node.intensity * emitted * received / select(squared > radius2, squared, radius2);
}

/// Probability of the first of two children. Neither is ever left out: bounds and receiver are rounded.
REALCAM_INLINE float first_child_probability(const LightNode& first, const LightNode& second, LightReceiver receiver) {
    constexpr float kLeast = 0.01f;
    const float a = light_importance(first, receiver), b = light_importance(second, receiver);
    const float share = a / (a + b);
    // The half is also returned where both are 0 or infinite.
    if (!(share >= 0.0f)) return 0.5f;
    return share < kLeast ? kLeast : share > 1.0f - kLeast ? 1.0f - kLeast : share;
}

struct LightChoice {
    std::int32_t light;  ///< a point light, or an area light after all point lights
    float probability;
    float fresh;  ///< a random number made of what the choice left over
};

/// `seed`: for random bits beyond the 24 of u, which the choices at 20 turns use up.
REALCAM_INLINE LightChoice choose_light(const SceneView& scene, LightReceiver receiver, float u, std::uint32_t seed) {
    float probability = 1.0f;
    std::int32_t at = 0;
    while (scene.light_nodes[at].second_child > 0) {
        const std::int32_t second = scene.light_nodes[at].second_child;
        const float first = first_child_probability(scene.light_nodes[at + 1], scene.light_nodes[second], receiver);
        const bool is_first = u < first;
        const float taken = is_first ? first : 1.0f - first;
        u = (is_first ? u : u - first) / taken;
        probability *= taken;
        // u stands on steps of 2^-24 / probability: anywhere in its step is as likely.
        seed = hash32(seed);
        u += unit_float(seed) * 0x1p-24f / probability;
        u = u < 0x1.fffffep-1f ? u : 0x1.fffffep-1f;
        at = is_first ? at + 1 : second;
    }
    const LightNode& leaf = scene.light_nodes[at];
    const std::int32_t light = -1 - leaf.second_child;
    if (leaf.partner < 0) return {light, probability, u};
    const bool is_first = u < leaf.first_share;
    const float taken = is_first ? leaf.first_share : 1.0f - leaf.first_share;
    u = (is_first ? u : u - leaf.first_share) / taken;
    return {is_first ? light : leaf.partner, probability * taken, u < 0x1.fffffep-1f ? u : 0x1.fffffep-1f};
}

/// Probability with which choose_light chooses a light.
REALCAM_INLINE float light_probability(const SceneView& scene, LightReceiver receiver, std::int32_t light) {
    float probability = 1.0f;
    std::uint64_t turns = scene.light_trails[light];
    std::int32_t at = 0;
    while (scene.light_nodes[at].second_child > 0) {
        const std::int32_t second = scene.light_nodes[at].second_child;
        const float first = first_child_probability(scene.light_nodes[at + 1], scene.light_nodes[second], receiver);
        const bool is_second = (turns & 1) != 0;
        probability *= is_second ? 1.0f - first : first;
        at = is_second ? second : at + 1;
        turns >>= 1;
    }
    const LightNode& leaf = scene.light_nodes[at];
    if (leaf.partner < 0) return probability;
    return probability * (light == leaf.partner ? 1.0f - leaf.first_share : leaf.first_share);
}

}  // namespace REALCAM_NAMESPACE
