#pragma once
#include <cstddef>

#include "../scene/light_tree.hpp"

namespace REALCAM_NAMESPACE {

/// What choose_light returns for many receivers.
template <int N>
struct LightChoices {
    Lanes<std::int32_t, N> light;
    Lanes<float, N> probability, fresh;

    REALCAM_INLINE LightChoice operator[](int place) const { return {light[place], probability[place], fresh[place]}; }
};

namespace light_choices_detail {

/// The nodes of a tree as two arrays of numbers: gcc has vector code for numbers at many places of an array, and none
/// for members of structures there.
class LightNodeNumbers {
public:
    REALCAM_INLINE explicit LightNodeNumbers(const LightNode* nodes)
        : floats_(&nodes->low.x), integers_(&nodes->second_child) {}

    REALCAM_INLINE std::int32_t second_child(std::int32_t node) const { return integers_[node * kStride]; }

    REALCAM_INLINE LightNode operator[](std::int32_t node) const {
        const std::int32_t at = node * kStride;
        LightNode all = {};
        all.low = {floats_[at], floats_[at + 1], floats_[at + 2]};
        all.high = {floats_[at + 3], floats_[at + 4], floats_[at + 5]};
        all.axis = {floats_[at + 6], floats_[at + 7], floats_[at + 8]};
        all.cos_spread = floats_[at + 9];
        all.intensity = floats_[at + 10];
        all.is_isotropic = integers_[at + 1];
        return all;
    }

private:
    static constexpr std::int32_t kStride = sizeof(LightNode) / sizeof(float);
    static_assert(offsetof(LightNode, high) == 3 * sizeof(float) && offsetof(LightNode, axis) == 6 * sizeof(float) &&
                  offsetof(LightNode, cos_spread) == 9 * sizeof(float) &&
                  offsetof(LightNode, intensity) == 10 * sizeof(float) &&
                  offsetof(LightNode, is_isotropic) == offsetof(LightNode, second_child) + sizeof(float));

    const float* floats_;
    const std::int32_t* integers_;
};

}  // namespace light_choices_detail

/// choose_light for many receivers at once. Those of a vector take their turns in the tree in step, which is vector
/// code. `receiver(i)`: at a place. `u`: below 1.
template <int N, class Receivers>
REALCAM_INLINE void choose_lights(const SceneView& scene, const Receivers& receiver, const float (&u)[N],
                                  const std::uint32_t (&seed)[N], int places, LightChoices<N>& chosen) {
    const light_choices_detail::LightNodeNumbers nodes(scene.light_nodes);
    Lanes<std::int32_t, N> node, first, second;
    Lanes<std::uint32_t, N> bits;
    Lanes<float, N> rest, probability;
    REALCAM_LANES
    for (int i = 0; i < places; ++i) {
        node[i] = 0;
        bits[i] = seed[i];
        rest[i] = u[i];
        probability[i] = 1.0f;
    }
    // By vectors, because each takes as many turns as its deepest light.
    constexpr int kWidth = whole_vectors<N>(1);
    for (int begin = 0; begin < places; begin += kWidth) {
        for (std::int32_t goes_on = nodes.second_child(0) > 0; goes_on != 0;) {
            goes_on = 0;
            // In a loop of its own, without which gcc makes 64-bit addresses of the nodes' numbers, and no vector code.
            REALCAM_LANES
            for (int i = begin; i < begin + kWidth; ++i) {
                const std::int32_t child = nodes.second_child(node[i]);
                second[i] = select(child > 0, child, 0);
                first[i] = select(child > 0, node[i] + 1, 0);
                goes_on |= second[i];
            }
            REALCAM_LANES
            for (int i = begin; i < begin + kWidth; ++i) {
                const bool is_inner = second[i] > 0;
                LightTreePath path = {rest[i], bits[i], node[i], probability[i]};
                path.take_turn(nodes, first[i], second[i], receiver(i));
                rest[i] = select(is_inner, path.u, rest[i]);
                bits[i] = path.seed;
                node[i] = select(is_inner, path.node, node[i]);
                probability[i] = select(is_inner, path.probability, probability[i]);
            }
        }
    }
    for (int i = 0; i < places; ++i) {
        const LightTreePath path = {rest[i], bits[i], node[i], probability[i]};
        const LightChoice choice = path.choice_at(scene.light_nodes[node[i]]);
        chosen.light[i] = choice.light;
        chosen.probability[i] = choice.probability;
        chosen.fresh[i] = choice.fresh;
    }
}

}  // namespace REALCAM_NAMESPACE
