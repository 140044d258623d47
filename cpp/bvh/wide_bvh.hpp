#pragma once
#include <cstdint>

#include "../math/affine.hpp"

namespace REALCAM_NAMESPACE {

// BVH with up to eight children per node and box planes of one byte (Ylitie, Karras and Laine, "Efficient Incoherent
// Ray Traversal on GPUs Through Compressed Wide BVHs", HPG 2017). Two things differ from the paper. Steps are bfloat16
// numbers instead of powers of two, which makes them three tenths smaller on average. Every slot has three bits for its
// triangles, so the box test only has to find the mask of the slots that a ray intersects.

inline constexpr unsigned kSlots = 8;
inline constexpr unsigned kTrianglesPerSlot = 3;

/// Greatest depth in nodes, which a traversal's stack must hold; the builder guarantees it.
inline constexpr unsigned kMaxBvhDepth = 48;

/// Node with eight slots; a slot holds a child node or up to three triangles, or is empty. Bit 0 of a slot's index is
/// set if its box lies towards +x of the others, bit 1 for +y, bit 2 for +z, as far as the other children allow.
struct alignas(16) WideNode {
    Vec3f origin;  ///< least corner of all boxes
    std::uint32_t steps_xy;  ///< two bfloat16 numbers, x in the upper half
    std::uint32_t step_z_reach;  ///< two bfloat16 numbers: the step of z in the upper half, and 18 * 255 times the
    ///< largest step, for the tolerance of SlabRay::intersected_slots
    std::uint32_t first_child;  ///< the node in the first slot that holds one; other child nodes follow in slot order
    std::uint32_t first_triangle;  ///< the first triangle; others follow in slot order
    std::uint32_t content;  ///< bits 3 s to 3 s + 2: triangles in slot s; bit 24 + s: slot s holds a node
    std::uint32_t lower[3][2];  ///< for each axis one byte per slot, slot 0 in the lowest byte: the lower plane of its
                                ///< box at origin + byte * step
    std::uint32_t upper[3][2];  ///< the upper planes likewise; below the lower ones if the slot is empty
};
static_assert(sizeof(WideNode) == 80);

/// Triangle as traversal reads it: its vertices, padded to 16 bytes each.
struct alignas(16) BvhTriangle {
    Vec3f a;
    std::uint32_t index;  ///< in the caller's list
    Vec3f b;
    std::uint32_t unused_b;
    Vec3f c;
    std::uint32_t unused_c;
};
static_assert(sizeof(BvhTriangle) == 48);

/// Non-owning view for traversal; node 0 is the root.
struct WideBvhView {
    const WideNode* nodes;
    const BvhTriangle* triangles;
};

/// Leaf of the BVH over the instances: an instance's transform and the BVH of its object.
struct alignas(16) BvhInstance {
    InverseAffine<float> object_from_render;
    WideBvhView object;
    std::uint32_t index;  ///< in the scene's list of instances
    std::uint32_t moves;  ///< not 0 if it moves while the shutter is open; the transform is then that at shutter open
};

/// BVH of the static geometry, and a BVH over the instances: its slots hold instances instead of triangles.
struct SceneBvhView {
    WideBvhView static_geometry;
    const WideNode* nodes;  ///< BVH over the instances; node 0 is the root
    const BvhInstance* instances;  ///< in the order of its leaves
};

}  // namespace REALCAM_NAMESPACE
