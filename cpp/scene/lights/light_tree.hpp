#pragma once
#include "../../math/random.hpp"
#include "../materials/light_sample.hpp"
#include "../scene_view.hpp"

namespace REALCAM_NAMESPACE {

// Light sampling by tree traversal (Conty Estevez and Kulla 2018). Each step chooses a child by the mean contribution
// of its lights to the receiver; choosing by the maximum, as in that paper, gives more noise.

/// Cosine of the difference a - b of two angles between 0 and pi, or 1 if b is larger.
REALCAM_INLINE float cosine_of_difference(float cos_a, float cos_b) {
    const float difference = cos_a * cos_b + sqrt_or_zero(1.0f - cos_a * cos_a) * sqrt_or_zero(1.0f - cos_b * cos_b);
    return select(cos_a >= cos_b, 1.0f, difference);
}

/// Cosine of the sum of two angles between 0 and pi, or -1 if the sum exceeds pi.
REALCAM_INLINE float cosine_of_sum(float cos_a, float cos_b) {
    const float sum = cos_a * cos_b - sqrt_or_zero(1.0f - cos_a * cos_a) * sqrt_or_zero(1.0f - cos_b * cos_b);
    return select(cos_a > -cos_b, sum, -1.0f);
}

/// Mean of the clamped cosine between a direction and the directions of a uniform cone. `cos_axis`: of the angle
/// between the direction and the cone's axis; `cos_spread`: of the cone's half angle. Exact for a direction on the axis
/// of a cone of up to a hemisphere, for a hemisphere, (1 + cos_axis) / 4, and for the sphere, 1 / 4; elsewhere within
/// 0.03.
REALCAM_INLINE float mean_cosine(float cos_axis, float cos_spread) {
    // The mean of max(c, 0) is approximated by (m + sqrt(m^2 + w)) / 2, where m is the mean of c, and w, which is 0 for
    // a single direction, is chosen so that the cases above are exact.
    const bool is_narrow = cos_spread > 0.0f;
    const float mean = 0.5f * (1.0f + cos_spread) * cos_axis;
    const float width = select(is_narrow, (1.0f - cos_spread * cos_spread) * (1.0f - 0.25f * cos_spread), 1.0f),
                across = 1.0f - select(is_narrow, 1.0f, 1.0f + cos_spread) * cos_axis * cos_axis;
    return 0.5f * (mean + sqrt_or_zero(mean * mean + 0.25f * width * across));
}

/// True if a node holds lights that radiate equally in all directions.
REALCAM_INLINE bool is_isotropic(const LightNode& node) {
    return node.cos_spread > 1.0f;
}

/// Geometry of a node's bounds relative to a receiver.
struct NodeView {
    float squared_distance;  ///< from the receiver to the centre of the bounds, m^2
    /// Cosine of the half angle that the bounds subtend; -1 from inside, where lights are in all directions.
    float cos_bounds;
    float cos_axis;  ///< cosine between the axis of emission and the direction to the receiver
    float cos_normal;  ///< cosine between the receiver's normal and the direction to the lights
    Vec3f to_middle;  ///< unit, from the receiver to the centre of the bounds

    REALCAM_INLINE NodeView(const LightNode& node, LightReceiver receiver) {
        const Vec3f offset = receiver.position - node.middle;
        squared_distance = dot(offset, offset);
        const bool is_outside = squared_distance > node.squared_radius;
        cos_bounds = select(is_outside, sqrt_or_zero(1.0f - node.squared_radius / squared_distance), -1.0f);
        const float inverse = 1.0f / std::sqrt(select(squared_distance > 1e-30f, squared_distance, 1e-30f));
        cos_axis = inverse * dot(node.axis, offset);
        cos_normal = -inverse * dot(receiver.normal, offset);
        to_middle = -inverse * offset;
    }
};

/// Approximate mean of a rough microfacet lobe over the directions of a node: BSDF times cosine over the lobe's albedo,
/// relative to the maximum of the Lambertian lobe.
REALCAM_INLINE float lobe_importance(const NodeView& seen, LightReceiver receiver) {
    const Vec3f sum = receiver.lobe.to_eye + seen.to_middle;
    // Without masking and Fresnel term, BSDF times cosine over 1 / pi is a^2 / (4 k^2 cos_eye), with k = 1 - cos^2 +
    // a^2 cos^2, where cos is the cosine between the normal and the half vector, which has the direction of the sum.
    const float inverse = 1.0f / at_least(dot(sum, sum), 1e-6f), along = dot(sum, receiver.normal),
                cosine2 = along * along * inverse;
    // a^2 is GGX alpha squared, increased by the squared range of half vectors over the node, which is larger the
    // shorter the sum is.
    const float sin2 = select(seen.cos_bounds > 0.0f, 1.0f - seen.cos_bounds * seen.cos_bounds, 1.0f),
                width2 = receiver.lobe.alpha * receiver.lobe.alpha + 0.25f * sin2 * inverse,
                a2 = select(width2 < 1.0f, width2, 1.0f), k = (1.0f - cosine2) + a2 * cosine2;
    const float density = 4.0f * k * k * at_least(dot(receiver.normal, receiver.lobe.to_eye), 1e-2f);
    // The mean, a2 / density, cannot exceed that of a lobe that lies entirely inside the node: 1 over the node's solid
    // angle in units of pi.
    const float solid_angle = 2.0f * at_least(1.0f - seen.cos_bounds, 1e-6f);
    const bool is_less = a2 * solid_angle < density;
    return select(is_less, a2, 1.0f) / select(is_less, density, solid_angle);
}

/// False for a receiver that light may reach from all directions.
REALCAM_INLINE bool has_normal(LightReceiver receiver) {
    return dot(receiver.normal, receiver.normal) > 0.0f;
}

/// Approximate unoccluded illuminance in lux from a node's lights: a mean over their positions and orientations within
/// the bounds. With a microfacet lobe, the share that this lobe scatters is weighted by the lobe's value in the node's
/// directions relative to the Lambertian one.
REALCAM_INLINE float light_importance(const LightNode& node, LightReceiver receiver) {
    const NodeView seen(node, receiver);
    const float emitted = mean_cosine(seen.cos_axis, cosine_of_sum(node.cos_spread, seen.cos_bounds)),
                received = mean_cosine(seen.cos_normal, seen.cos_bounds);
    float scattered = select(has_normal(receiver), received, 1.0f);
    if (receiver.lobe.share > 0.0f && received > 0.0f) {
        // Below 1, so that lights that the lobe's estimate misses keep a non-zero probability.
        constexpr float kLobeTrust = 0.9f;
        scattered += kLobeTrust * receiver.lobe.share * (lobe_importance(seen, receiver) - received);
    }
    // The mean of 1 / distance^2 from the centre over a ball is 3 / radius^2.
    const float min_squared_distance = (1.0f / 3.0f) * node.squared_radius;
    return node.intensity * select(is_isotropic(node), 1.0f, emitted) * scattered /
           select(seen.squared_distance > min_squared_distance, seen.squared_distance, min_squared_distance);
}

/// Upper bound of the unoccluded illuminance in lux from a node's lights, for a receiver outside their bounds; 0 if
/// none of them can illuminate it.
REALCAM_INLINE float max_illuminance(const LightNode& node, LightReceiver receiver) {
    const NodeView seen(node, receiver);
    const auto positive = [](float v) { return select(v > 0.0f, v, 0.0f); };
    const float emitted = cosine_of_difference(cosine_of_difference(seen.cos_axis, node.cos_spread), seen.cos_bounds),
                received = cosine_of_difference(seen.cos_normal, seen.cos_bounds);
    return node.intensity * select(is_isotropic(node), 1.0f, positive(emitted)) *
           select(has_normal(receiver), positive(received), 1.0f) /
           select(seen.squared_distance > node.squared_radius, seen.squared_distance, node.squared_radius);
}

/// Probability of the first of two children. Clamped away from 0 and 1, because bounds and receiver are rounded.
REALCAM_INLINE float first_child_probability(const LightNode& first, const LightNode& second, LightReceiver receiver) {
    constexpr float kMin = 0.01f;
    const float a = light_importance(first, receiver), b = light_importance(second, receiver);
    const float ratio = a / (a + b), at_least_min = select(ratio > kMin, ratio, kMin);
    // The ratio is NaN if both are 0 or infinite.
    return select(ratio >= 0.0f, select(at_least_min < 1.0f - kMin, at_least_min, 1.0f - kMin), 0.5f);
}

/// A chosen light.
struct LightChoice {
    std::int32_t light;  ///< index among the point lights, then the area lights
    float probability;  ///< with which it was chosen
    float fresh;  ///< random number in [0, 1), rescaled from the remainder of the choice
};

/// Traversal of the light tree from its root to a leaf.
struct LightTreePath {
    float u;  ///< random number in [0, 1), from which each step takes its part
    std::uint32_t seed;  ///< for random bits beyond the 24 of u, which 20 steps use up
    std::int32_t node = 0;  ///< index of the node that was reached
    float probability = 1.0f;  ///< of the steps taken so far

    /// Descends to one of the node's two children, whose indices are `node + 1` and `second`. Returns true for the
    /// first.
    REALCAM_INLINE bool descend(const LightNode& first_child, const LightNode& second_child, std::int32_t second,
                                LightReceiver receiver) {
        const float of_first = first_child_probability(first_child, second_child, receiver);
        const bool is_first = u < of_first;
        const float of_chosen = select(is_first, of_first, 1.0f - of_first);
        probability *= of_chosen;
        // Rescaled to [0, 1), u is a multiple of 2^-24 / probability: random bits are added below that step.
        seed = hash32(seed);
        u = below_one(select(is_first, u, u - of_first) / of_chosen + unit_float(seed) * 0x1p-24f / probability);
        node = select(is_first, node + 1, second);
        return is_first;
    }
    /// Chooses one of the lights of the leaf that was reached.
    REALCAM_INLINE LightChoice choice(const SceneView& scene) const {
        const LightNode& leaf = scene.light_nodes[node];
        const std::int32_t first = -1 - leaf.second_child;
        if (leaf.partner == -1) return {first, probability, u};
        if (leaf.partner >= 0) {
            const bool is_first = u < leaf.first_probability;
            const float in_leaf = is_first ? leaf.first_probability : 1.0f - leaf.first_probability;
            return {is_first ? first : leaf.partner, probability * in_leaf,
                    remapped_random(is_first ? u : u - leaf.first_probability, in_leaf)};
        }
        const LeafLight* entry = &scene.leaf_lights[-2 - leaf.partner];
        while (entry[1].below <= u) ++entry;
        const float in_leaf = entry[1].below - entry->below;
        return {entry->light, probability * in_leaf, remapped_random(u - entry->below, in_leaf)};
    }
};

/// Chooses one of the point and area lights by descending the tree. The scene must have one. `u`: random number in
/// [0, 1); `seed`: see LightTreePath.
REALCAM_INLINE LightChoice choose_light(const SceneView& scene, LightReceiver receiver, float u, std::uint32_t seed) {
    LightTreePath path{u, seed};
    const LightNode* const nodes = scene.light_nodes;
    for (std::int32_t second; (second = nodes[path.node].second_child) > 0;)
        path.descend(nodes[path.node + 1], nodes[second], second, receiver);
    return path.choice(scene);
}

/// Probability with which choose_light chooses a light. `light`: index among the point lights, then the area lights.
REALCAM_INLINE float light_probability(const SceneView& scene, LightReceiver receiver, std::int32_t light) {
    float probability = 1.0f;
    std::uint64_t trail = scene.light_trails[light];
    std::int32_t node = 0;
    while (scene.light_nodes[node].second_child > 0) {
        const std::int32_t second = scene.light_nodes[node].second_child;
        const float first = first_child_probability(scene.light_nodes[node + 1], scene.light_nodes[second], receiver);
        const bool is_second = (trail & 1) != 0;
        probability *= is_second ? 1.0f - first : first;
        node = is_second ? second : node + 1;
        trail >>= 1;
    }
    const LightNode& leaf = scene.light_nodes[node];
    if (leaf.partner == -1) return probability;
    if (leaf.partner < -1) return probability * scene.leaf_probabilities[light];
    return probability * (light == leaf.partner ? 1.0f - leaf.first_probability : leaf.first_probability);
}

}  // namespace REALCAM_NAMESPACE
