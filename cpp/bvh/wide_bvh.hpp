#pragma once
#include <cstdint>

#include "../math/affine.hpp"

namespace REALCAM_NAMESPACE {

// A hierarchy of boxes with up to eight children to a node, and boxes of one byte to a plane (Ylitie, Karras and Laine,
// "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", HPG 2017). Two things differ from the
// paper. Steps are bfloat16 numbers instead of powers of two, which makes them three tenths smaller on average. Every
// slot has three bits for its triangles, so the box test has to find only the mask of the slots that a ray meets.

inline constexpr unsigned kSlots = 8;
inline constexpr unsigned kTrianglesPerSlot = 3;

/// Nodes on the way from the root to the deepest, at most: what a traversal's stack must hold. The builder keeps to it.
inline constexpr unsigned kMaxBvhDepth = 48;

/// Eight slots, each with a node, up to three triangles, or nothing. Bit 0 of a slot's number is set if its box lies
/// towards +x of the others, bit 1 for +y, bit 2 for +z, as far as there is room.
struct alignas(16) WideNode {
    Vec3f origin;
    std::uint32_t steps_xy;  ///< two bfloat16 numbers, x in the upper half
    std::uint32_t step_z_reach;  ///< likewise the step of z, and 18 * 255 times the largest step
    std::uint32_t first_child;  ///< the node in the first slot that holds one; the others follow in the order of slots
    std::uint32_t first_triangle;  ///< likewise
    std::uint32_t content;  ///< bits 3 s to 3 s + 2: triangles in slot s; bit 24 + s: it holds a node
    std::uint32_t lower[3][2];  ///< for each axis a byte for each slot: the plane at origin + byte * step
    std::uint32_t upper[3][2];
};
static_assert(sizeof(WideNode) == 80);

struct alignas(16) BvhTriangle {
    Vec3f a;
    std::uint32_t index;  ///< in the caller's list
    Vec3f b;
    std::uint32_t unused_b;
    Vec3f c;
    std::uint32_t unused_c;
};
static_assert(sizeof(BvhTriangle) == 48);

/// What a traversal reads: node 0 is the root.
struct WideBvhView {
    const WideNode* nodes;
    const BvhTriangle* triangles;
};

/// The transform of an instance, with its object's own hierarchy.
struct alignas(16) BvhInstance {
    InverseAffine<float> object_from_render;
    WideBvhView object;
    std::uint32_t index;  ///< in the scene's list
    std::uint32_t moves;  ///< not 0: while the shutter is open, and the transform is that of its begin
};

/// Static geometry's triangles, and a hierarchy over objects: its slots hold instances instead of triangles.
struct SceneBvhView {
    WideBvhView static_geometry;
    const WideNode* nodes;
    const BvhInstance* instances;
};

}  // namespace REALCAM_NAMESPACE
