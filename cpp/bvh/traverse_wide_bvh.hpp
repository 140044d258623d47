#pragma once
#include "../scene/geometry/opacity.hpp"
#include "ray_intersection.hpp"

namespace REALCAM_NAMESPACE {

/// Child nodes of a node that the ray intersects and has not entered yet.
struct PendingSlots {
    std::uint32_t first_child;  ///< WideNode::first_child of the node
    std::uint32_t slots;  ///< bits 0 to 7: slots to enter; bits 8 to 15: all slots that hold nodes
};

/// Traversal stack; each level of the BVH pushes at most one entry. It is not a member of Traversal: an array with a
/// dynamic index is placed in memory on a GPU, and so would be the whole ray around it.
using TraversalStack = PendingSlots[kMaxBvhDepth];

/// Traversal of one wide BVH by a ray, as a state machine. It can be suspended after each step, so that a GPU's lanes
/// whose rays have ended can take new ones before the longest ray of the warp ends.
///
/// `far`: end of the ray, in units of the direction's length. With `any`, traversal ends at the first triangle found. A
/// ray hits nothing if one of its numbers is not finite
/// (`far` may be infinite) or if the largest component of its direction is zero or subnormal.
class Traversal {
public:
    REALCAM_INLINE Traversal(Vec3f origin, Vec3f direction, float far, bool any)
        : Traversal(origin, direction, far, any, exponent_of(largest_coordinate(direction))) {}

    /// True if nodes or triangles remain to be tested.
    REALCAM_INLINE bool active() const { return ((pending_.slots & 0xffu) | triangles_) != 0; }

    /// Enters one node, unless triangles of the last one are pending, and tests up to kTrianglesPerStep triangles.
    /// `scene_ray`: PlainSceneRay or AnySceneRay (opacity.hpp), which decides whether the ray stops at a hit. The ray
    /// must be active.
    template <class SceneRay>
    REALCAM_INLINE void step(const WideBvhView& bvh, TraversalStack& stack, const SceneRay& scene_ray) {
        if (!triangles_) enter_node<false>(bvh.nodes, stack);
        if (intersect_triangles(bvh.triangles, kNoInstance, scene_ray) && any_)
            pending_.slots = triangles_ = 0;
        else if (!active() && stack_size_ > 0)
            pending_ = stack[--stack_size_];
    }

    /// Returns the result after the last step. `far`: as given to the constructor. Without a hit: kNoTriangle at the
    /// distance `far`.
    REALCAM_INLINE Hit hit(float far) const {
        if (hit_.triangle == kNoTriangle) return {far, kNoTriangle, 0, 0};
        Hit hit = hit_;
        hit.distance *= scale_;
        return hit;
    }

protected:
    /// Most triangles tested per step: nodes with more are rare, and the other lanes would wait.
    static constexpr int kTrianglesPerStep = 2;

    /// The root node, as the first child of an imaginary node whose slot 0 holds it.
    REALCAM_INLINE static PendingSlots pending_root() { return {0, 0x0101u}; }

    REALCAM_INLINE static unsigned lowest_bit(unsigned bits) { return bits & (0u - bits); }

    /// Biased exponent of a float of at least 0, clamped so that the power of two that undoes it is a normal number.
    REALCAM_INLINE static std::uint32_t exponent_of(float size) {
        const std::uint32_t exponent = std::bit_cast<std::uint32_t>(size) >> 23;
        return exponent < 253u ? exponent : 253u;
    }

    /// Scales the direction by a power of two, so that its largest component is 1 to 2 (4 at the end of the range) and
    /// nothing overflows. `exponent`: exponent_of the largest component.
    REALCAM_INLINE Traversal(Vec3f origin, Vec3f direction, float far, bool any, std::uint32_t exponent)
        : any_(any),
          scale_(std::bit_cast<float>((254u - exponent) << 23)),
          slabs_(origin, scale_ * direction),
          sheared_(origin, scale_ * direction),
          hit_{far * std::bit_cast<float>(exponent << 23), kNoTriangle, 0, 0} {
        // sum - sum is NaN if one of the numbers is infinite or NaN.
        const float sum = origin.x + origin.y + origin.z + direction.x + direction.y + direction.z;
        if (!(sum - sum == 0) || exponent == 0 || !(hit_.distance > 0)) pending_.slots = 0;
    }

    /// Continues with the ray transformed into another frame, whose origin and direction are given. The closest hit so
    /// far and the stack entries are kept; the next step enters the root of the BVH in that frame.
    REALCAM_INLINE void transform_ray(Vec3f origin, Vec3f direction) {
        const Hit so_far = hit_;
        const int stack_size = stack_size_;
        *this = Traversal(origin, direction, so_far.distance * scale_, any_);
        hit_.triangle = so_far.triangle;
        hit_.u = so_far.u;
        hit_.v = so_far.v;
        hit_.instance = so_far.instance;
        stack_size_ = stack_size;
    }

    /// Tests up to kTrianglesPerStep triangles of the last node; with `any`, only until the first hit. `instance`:
    /// stored in the hit. Returns true if there was a hit.
    template <class SceneRay>
    REALCAM_INLINE bool intersect_triangles(const BvhTriangle* triangles, std::uint32_t instance,
                                            const SceneRay& scene_ray) {
        bool has_hit = false;
        for (int i = 0; i < kTrianglesPerStep; ++i) {
            if (!triangles_) break;
            const unsigned lowest = lowest_bit(triangles_);
            triangles_ ^= lowest;
            const std::uint32_t index = first_triangle_ + count_bits(content_ & (lowest - 1u));
            const Hit last = hit_;
            if (!intersects_triangle(sheared_, load_constant(triangles + index), hit_)) continue;
            hit_.instance = instance;
            if constexpr (!SceneRay::is_plain) {
                if (!scene_ray.stops(hit_)) {
                    hit_ = last;
                    continue;
                }
            }
            has_hit = true;
            if (any_) break;
        }
        return has_hit;
    }

    /// Enters the next node in order along the ray, and stores its intersected children and triangles in `pending_` and
    /// `triangles_`. `has_less_code`: see SlabRay::intersected_slots.
    template <bool has_less_code>
    REALCAM_INLINE void enter_node(const WideNode* nodes, PendingSlots* stack) {
        const unsigned slot = slabs_.nearest(pending_.slots & 0xffu);
        const std::uint32_t index = pending_.first_child + count_bits(pending_.slots >> 8 & (slot - 1u));
        pending_.slots ^= slot;
        if (pending_.slots & 0xffu) stack[stack_size_++] = pending_;
        const WideNode node = load_constant(nodes + index);
        const unsigned intersected = slabs_.intersected_slots<has_less_code>(node, hit_.distance);
        const unsigned children = node.content >> 24;
        pending_ = {node.first_child, (intersected & children) | children << 8};
        content_ = node.content;
        first_triangle_ = node.first_triangle;
        triangles_ = triple_bits(intersected) & content_;
    }

    /// Repeats each of the lower eight bits three times, which is the layout of the triangle bits in WideNode::content.
    REALCAM_INLINE static unsigned triple_bits(unsigned slots) {
        slots = (slots | slots << 8) & 0x00f00fu;
        slots = (slots | slots << 4) & 0x0c30c3u;
        slots = (slots | slots << 2) & 0x249249u;
        return slots * 7u;
    }

    bool any_;  ///< true: ends at the first hit found
    float scale_;  ///< length of the scaled direction over that of the original one
    SlabRay slabs_;
    ShearedRay sheared_;
    Hit hit_;  ///< in units of the scaled direction; its distance is the ray's end as long as there is no hit
    PendingSlots pending_ = pending_root();
    /// Triangles of the last node yet to be tested, as bits of WideNode::content, and the node's content and first
    /// triangle.
    std::uint32_t triangles_ = 0, content_ = 0, first_triangle_ = 0;
    int stack_size_ = 0;  ///< number of stack entries in use
};

/// Traces a ray to the end; `any`: ends at the first hit found. Returns Traversal::hit. One function serves closest-hit
/// and any-hit rays, because a kernel with a traversal for each is slower
/// (docs/decisions/gpu-kernel.md).
template <class SceneRay>
REALCAM_ONE_COPY Hit traverse(const WideBvhView& bvh, Vec3f origin, Vec3f direction, float far, bool any,
                              SceneRay scene_ray) {
    Traversal ray(origin, direction, far, any);
    TraversalStack stack;
    while (ray.active()) ray.step(bvh, stack, scene_ray);
    return ray.hit(far);
}

/// Returns the nearest hit at a distance in [0, far), in units of the direction's length, which need not be 1.
/// Barycentric coordinates are those of the second and third vertex, as in Embree. Without a hit: kNoTriangle at the
/// distance `far`.
template <class SceneRay = PlainSceneRay>
REALCAM_HD inline Hit closest_hit(const WideBvhView& bvh, Vec3f origin, Vec3f direction, float far,
                                  const SceneRay& scene_ray = {}) {
    return traverse(bvh, origin, direction, far, false, scene_ray);
}

/// True if there is a hit at a distance in [0, far), in units of the direction's length.
template <class SceneRay = PlainSceneRay>
REALCAM_HD inline bool any_hit(const WideBvhView& bvh, Vec3f origin, Vec3f direction, float far,
                               const SceneRay& scene_ray = {}) {
    return traverse(bvh, origin, direction, far, true, scene_ray).triangle != kNoTriangle;
}

}  // namespace REALCAM_NAMESPACE
