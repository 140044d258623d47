#pragma once
#include "../../scene/lights/light_tree.hpp"

namespace REALCAM_NAMESPACE {

/// Results of choose_light for many receivers: one LightChoice per lane.
template <int N>
struct LightChoices {
    Lanes<std::int32_t, N> light;
    Lanes<float, N> probability, fresh;  ///< see LightChoice

    REALCAM_INLINE LightChoice operator[](int slot) const { return {light[slot], probability[slot], fresh[slot]}; }
};

namespace light_choices_detail {

/// Light-tree nodes, one per lane. The members are stored in groups of four numbers, because gcc loads whole groups and
/// shuffles them into vectors; for single numbers of scattered nodes it emits one instruction each.
template <int N>
class LightNodeLanes {
public:
    REALCAM_INLINE void set(int lane, const LightNode& node) {
        const float ball[] = {node.middle.x, node.middle.y, node.middle.z, node.squared_radius},
                    cone[] = {node.axis.x, node.axis.y, node.axis.z, node.cos_spread};
        for (int k = 0; k < 4; ++k) {
            ball_[4 * lane + k] = ball[k];
            cone_[4 * lane + k] = cone[k];
        }
        intensity_[lane] = node.intensity;
        second_child[lane] = node.second_child;
    }
    REALCAM_INLINE LightNode operator[](int lane) const {
        const float *const ball = &ball_[4 * lane], *const cone = &cone_[4 * lane];
        // The last three members, the links to children and lights, are not needed to weigh a node.
        return {
            {ball[0], ball[1], ball[2]}, ball[3], {cone[0], cone[1], cone[2]}, cone[3], intensity_[lane], 0, -1, 1.0f};
    }

    Lanes<std::int32_t, N> second_child;

private:
    Lanes<float, 4 * N> ball_, cone_;
    Lanes<float, N> intensity_;
};

}  // namespace light_choices_detail

/// Chooses a point or area light for each of many receivers by descending the light tree, as choose_light does for one.
/// The receivers of a vector descend in step, so that the arithmetic is vectorised. `receiver(i)`: returns the
/// LightReceiver of slot i. `u`, `seed`: random number in [0, 1) and random bits of each slot. `slots`: number of
/// slots, a multiple of the vector width. `chosen`: receives the result of each slot.
template <int N, class Receivers>
REALCAM_INLINE void choose_lights(const SceneView& scene, const Receivers& receiver, const float (&u)[N],
                                  const std::uint32_t (&seed)[N], int slots, LightChoices<N>& chosen) {
    // One vector at a time: the number of steps is the largest depth among the lanes.
    constexpr int kWidth = whole_vectors<N>(1);
    const LightNode* const nodes = scene.light_nodes;
    for (int begin = 0; begin < slots; begin += kWidth) {
        Lanes<std::int32_t, kWidth> node, second;
        Lanes<std::uint32_t, kWidth> bits;
        Lanes<float, kWidth> remaining_u, probability;
        REALCAM_LANES
        for (int i = 0; i < kWidth; ++i) {
            node[i] = 0;
            second[i] = nodes[0].second_child;
            bits[i] = seed[begin + i];
            remaining_u[i] = u[begin + i];
            probability[i] = 1.0f;
        }
        for (bool any_is_inner = nodes[0].second_child > 0; any_is_inner;) {
            light_choices_detail::LightNodeLanes<kWidth> firsts, seconds;  // children
            for (int i = 0; i < kWidth; ++i) {
                // Lanes that have reached a leaf evaluate the root's children, and keep their node.
                const bool is_inner = second[i] > 0;
                firsts.set(i, nodes[is_inner ? node[i] + 1 : 1]);
                seconds.set(i, nodes[is_inner ? second[i] : 1]);
            }
            std::int32_t any_inner = 0;
            REALCAM_LANES
            for (int i = 0; i < kWidth; ++i) {
                const bool is_inner = second[i] > 0;
                LightTreePath path = {remaining_u[i], bits[i], node[i], probability[i]};
                const bool is_first = path.descend(firsts[i], seconds[i], second[i], receiver(begin + i));
                remaining_u[i] = select(is_inner, path.u, remaining_u[i]);
                bits[i] = path.seed;
                node[i] = select(is_inner, path.node, node[i]);
                probability[i] = select(is_inner, path.probability, probability[i]);
                const std::int32_t next = select(is_first, firsts.second_child[i], seconds.second_child[i]);
                second[i] = select(is_inner, next, second[i]);
                any_inner |= select(second[i] > 0, 1, 0);
            }
            any_is_inner = any_inner != 0;
        }
        for (int i = 0; i < kWidth; ++i) {
            const LightChoice choice = LightTreePath{remaining_u[i], bits[i], node[i], probability[i]}.choice(scene);
            chosen.light[begin + i] = choice.light;
            chosen.probability[begin + i] = choice.probability;
            chosen.fresh[begin + i] = choice.fresh;
        }
    }
}

}  // namespace REALCAM_NAMESPACE
