#pragma once
#include "slab_ray.hpp"
#include "watertight_triangle.hpp"

namespace REALCAM_NAMESPACE {

/// For those who want to know what a ray costs: a type like this one that counts.
struct NoTraversalProbe {
    REALCAM_INLINE void node() const {}
    REALCAM_INLINE void triangle() const {}
};

namespace traversal_detail {

/// Slots of one node that a ray has met and not entered yet.
struct Pending {
    std::uint32_t first_child;
    std::uint32_t slots;  ///< bits 0 to 7: to be entered; bits 8 to 15: all that hold nodes
};

/// Each of the lower eight bits three times, as the triangles of a node lie.
REALCAM_INLINE unsigned triple_bits(unsigned slots) {
    slots = (slots | slots << 8) & 0x00f00fu;
    slots = (slots | slots << 4) & 0x0c30c3u;
    slots = (slots | slots << 2) & 0x249249u;
    return slots * 7u;
}

}  // namespace traversal_detail

/// The nearest triangle that a ray meets, or for `any`: the first that is found. A ray with a number that is not finite
/// (`far` may be infinite), or without a direction of normal floating-point size, meets nothing.
template <bool any, class Probe = NoTraversalProbe>
REALCAM_HD inline Hit traverse(const WideBvhView& bvh, Vec3f origin, Vec3f direction, float far, Probe&& probe = {}) {
    const Hit none = {far, kNoTriangle, 0, 0};
    const float size = largest_coordinate(direction);
    const float sum = origin.x + origin.y + origin.z + direction.x + direction.y + direction.z;
    if (!(sum - sum == 0) || !(size >= 0x1p-126f)) return none;
    // A power of two makes the largest component 1 to 2 (4 at the end of the range), so that nothing overflows.
    std::uint32_t exponent = std::bit_cast<std::uint32_t>(size) >> 23;
    exponent = exponent < 253u ? exponent : 253u;
    const float scale = std::bit_cast<float>((254u - exponent) << 23);
    direction = scale * direction;
    Hit hit = {far * std::bit_cast<float>(exponent << 23), kNoTriangle, 0, 0};  // the end, until there is a hit
    if (!(hit.distance > 0)) return none;

    const SlabRay slabs(origin, direction);
    const ShearedRay sheared(origin, direction);
    traversal_detail::Pending stack[kMaxBvhDepth];
    int waiting = 0;
    traversal_detail::Pending pending = {0, 0x0101u};
    for (;;) {
        const unsigned slot = slabs.nearest(pending.slots & 0xffu);
        const std::uint32_t index = pending.first_child + count_bits(pending.slots >> 8 & (slot - 1u));
        pending.slots ^= slot;
        if (pending.slots & 0xffu) stack[waiting++] = pending;

        const WideNode node = load_constant(bvh.nodes + index);
        probe.node();
        const unsigned met = slabs.slots_met(node, hit.distance);
        const unsigned children = node.content >> 24;
        pending = {node.first_child, (met & children) | children << 8};
        for (unsigned triangles = traversal_detail::triple_bits(met) & node.content; triangles;) {
            const unsigned first = triangles & (0u - triangles);
            triangles ^= first;
            const std::uint32_t number = node.first_triangle + count_bits(node.content & 0xffffffu & (first - 1u));
            const BvhTriangle triangle = load_constant(bvh.triangles + number);
            probe.triangle();
            if (meets_triangle(sheared, triangle, hit) && any) return hit;
        }
        if (!(pending.slots & 0xffu)) {
            if (waiting == 0) break;
            pending = stack[--waiting];
        }
    }
    hit.distance *= scale;
    return hit.triangle == kNoTriangle ? none : hit;
}

/// The nearest triangle at a distance in [0, far), in lengths of the direction, which need not be 1. Barycentrics as
/// Embree's: of the second and third corner. No hit: kNoTriangle, and `far` as the distance.
REALCAM_HD inline Hit closest_hit(const WideBvhView& bvh, Vec3f origin, Vec3f direction, float far) {
    return traverse<false>(bvh, origin, direction, far);
}

/// Whether there is a triangle at a distance in [0, far), in lengths of the direction.
REALCAM_HD inline bool any_hit(const WideBvhView& bvh, Vec3f origin, Vec3f direction, float far) {
    return traverse<true>(bvh, origin, direction, far).triangle != kNoTriangle;
}

}  // namespace REALCAM_NAMESPACE
