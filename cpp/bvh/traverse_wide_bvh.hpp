#pragma once
#include "../scene/scene_ray.hpp"
#include "slab_ray.hpp"
#include "watertight_triangle.hpp"

namespace REALCAM_NAMESPACE {

/// Slots of one node that a ray meets and has not entered yet.
struct PendingSlots {
    std::uint32_t first_child;
    std::uint32_t slots;  ///< bits 0 to 7: to be entered; bits 8 to 15: all that hold nodes
};

/// Where a ray has still to go; each level of the hierarchy puts at most one entry here. Not a part of Traversal: an
/// array with a running index lies in memory on a GPU, and would draw the whole ray after it.
using TraversalStack = PendingSlots[kMaxBvhDepth];

/// A ray on its way through the hierarchy. It can be left after each step, so that a GPU's lanes whose rays have ended
/// can take new ones before the longest of the warp has.
///
/// For `any`, it ends at the first triangle that is found. A ray with a number that is not finite (`far` may be
/// infinite), or without a direction of normal floating-point size, meets nothing.
class Traversal {
public:
    REALCAM_INLINE Traversal(Vec3f origin, Vec3f direction, float far, bool any)
        : Traversal(origin, direction, far, any, exponent_of(largest_coordinate(direction))) {}

    REALCAM_INLINE bool active() const { return ((pending_.slots & 0xffu) | triangles_) != 0; }

    /// One node, unless triangles of the last one are left, and up to kTrianglesPerStep triangles. The ray is active.
    template <class SceneRay>
    REALCAM_INLINE void step(const WideBvhView& bvh, TraversalStack& stack, const SceneRay& scene_ray) {
        if (!triangles_) enter_node<false>(bvh.nodes, stack);
        if (meet_triangles(bvh.triangles, kNoInstance, scene_ray) && any_)
            pending_.slots = triangles_ = 0;
        else if (!active() && waiting_ > 0)
            pending_ = stack[--waiting_];
    }

    /// After the last step. No hit: kNoTriangle, and `far` as the distance.
    REALCAM_INLINE Hit hit(float far) const {
        if (hit_.triangle == kNoTriangle) return {far, kNoTriangle, 0, 0};
        Hit hit = hit_;
        hit.distance *= scale_;
        return hit;
    }

protected:
    /// Nodes with more are rare, and the other lanes would wait.
    static constexpr int kTrianglesPerStep = 2;

    REALCAM_INLINE static std::uint32_t exponent_of(float size) {
        const std::uint32_t exponent = std::bit_cast<std::uint32_t>(size) >> 23;
        return exponent < 253u ? exponent : 253u;
    }

    /// A power of two makes the largest component 1 to 2 (4 at the end of the range), so that nothing overflows.
    REALCAM_INLINE Traversal(Vec3f origin, Vec3f direction, float far, bool any, std::uint32_t exponent)
        : any_(any),
          scale_(std::bit_cast<float>((254u - exponent) << 23)),
          slabs_(origin, scale_ * direction),
          sheared_(origin, scale_ * direction),
          hit_{far * std::bit_cast<float>(exponent << 23), kNoTriangle, 0, 0} {
        const float sum = origin.x + origin.y + origin.z + direction.x + direction.y + direction.z;
        if (!(sum - sum == 0) || exponent == 0 || !(hit_.distance > 0)) pending_.slots = 0;
    }

    /// The ray in another frame, as far as it goes by now, before its first step there. What waits keeps waiting.
    REALCAM_INLINE void turn_to(Vec3f origin, Vec3f direction) {
        const Hit so_far = hit_;
        const int waiting = waiting_;
        *this = Traversal(origin, direction, so_far.distance * scale_, any_);
        hit_.triangle = so_far.triangle;
        hit_.u = so_far.u;
        hit_.v = so_far.v;
        hit_.instance = so_far.instance;
        waiting_ = waiting;
    }

    /// Up to kTrianglesPerStep of the last node; for `any`, until the first hit. Whether there was one.
    template <class SceneRay>
    REALCAM_INLINE bool meet_triangles(const BvhTriangle* triangles, std::uint32_t instance,
                                       const SceneRay& scene_ray) {
        bool met = false;
        for (int i = 0; i < kTrianglesPerStep; ++i) {
            if (!triangles_) break;
            const unsigned first = triangles_ & (0u - triangles_);
            triangles_ ^= first;
            const std::uint32_t number = first_triangle_ + count_bits(content_ & (first - 1u));
            const Hit last = hit_;
            if (!meets_triangle(sheared_, load_constant(triangles + number), hit_)) continue;
            hit_.instance = instance;
            if constexpr (!SceneRay::is_plain) {
                if (!scene_ray.stops(hit_)) {
                    hit_ = last;
                    continue;
                }
            }
            met = true;
            if (any_) break;
        }
        return met;
    }

    /// Goes to the next node in order, and leaves in `pending_` and `triangles_` what the ray meets there.
    template <bool is_short>
    REALCAM_INLINE void enter_node(const WideNode* nodes, PendingSlots* stack) {
        const unsigned slot = slabs_.nearest(pending_.slots & 0xffu);
        const std::uint32_t index = pending_.first_child + count_bits(pending_.slots >> 8 & (slot - 1u));
        pending_.slots ^= slot;
        if (pending_.slots & 0xffu) stack[waiting_++] = pending_;
        const WideNode node = load_constant(nodes + index);
        const unsigned met = slabs_.slots_met<is_short>(node, hit_.distance);
        const unsigned children = node.content >> 24;
        pending_ = {node.first_child, (met & children) | children << 8};
        content_ = node.content;
        first_triangle_ = node.first_triangle;
        triangles_ = triple_bits(met) & content_;
    }

    /// Each of the lower eight bits three times, as the triangles of a node lie.
    REALCAM_INLINE static unsigned triple_bits(unsigned slots) {
        slots = (slots | slots << 8) & 0x00f00fu;
        slots = (slots | slots << 4) & 0x0c30c3u;
        slots = (slots | slots << 2) & 0x249249u;
        return slots * 7u;
    }

    bool any_;
    float scale_;
    SlabRay slabs_;
    ShearedRay sheared_;
    Hit hit_;  ///< the ray's end, until there is one
    PendingSlots pending_ = {0, 0x0101u};
    std::uint32_t triangles_ = 0, content_ = 0, first_triangle_ = 0;  ///< of the last node
    int waiting_ = 0;
};

/// Of both kinds of rays, because a kernel with a traversal for each is slower (docs/decisions/gpu-kernel.md).
template <class SceneRay>
REALCAM_ONE_COPY Hit traverse(const WideBvhView& bvh, Vec3f origin, Vec3f direction, float far, bool any,
                              SceneRay scene_ray) {
    Traversal ray(origin, direction, far, any);
    TraversalStack stack;
    while (ray.active()) ray.step(bvh, stack, scene_ray);
    return ray.hit(far);
}

/// The nearest triangle at a distance in [0, far), in lengths of the direction, which need not be 1. Barycentrics as
/// Embree's: of the second and third corner. No hit: kNoTriangle, and `far` as the distance.
template <class SceneRay = PlainSceneRay>
REALCAM_HD inline Hit closest_hit(const WideBvhView& bvh, Vec3f origin, Vec3f direction, float far,
                                  const SceneRay& scene_ray = {}) {
    return traverse(bvh, origin, direction, far, false, scene_ray);
}

/// Whether there is a triangle at a distance in [0, far), in lengths of the direction.
template <class SceneRay = PlainSceneRay>
REALCAM_HD inline bool any_hit(const WideBvhView& bvh, Vec3f origin, Vec3f direction, float far,
                               const SceneRay& scene_ray = {}) {
    return traverse(bvh, origin, direction, far, true, scene_ray).triangle != kNoTriangle;
}

}  // namespace REALCAM_NAMESPACE
