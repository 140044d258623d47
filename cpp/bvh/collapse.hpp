#pragma once
#include "binary_tree.hpp"

namespace REALCAM_NAMESPACE {

// Chooses which nodes of a binary tree become the children of a wide node, so that the cost of the whole by the surface
// area heuristic is least. It is dynamic programming from the leaves up (Ylitie, Karras and Laine 2017, section 3.1).

/// Cost of testing a triangle, where that of a node with its eight boxes is 1.
inline constexpr float kTriangleCost = 0.5f;

/// Fills in boxes, triangle counts and parents of a node and all below it, in parallel.
void measure(BinaryNode& node);

/// Finds the choices that `children_of` follows for a node and all below it, which have been measured; in parallel.
void plan_collapse(BinaryNode& node);

/// Keeps a node what its parent takes it for, a wide node, after it has been planned again.
inline void keep_as_node(InnerNode& node) {
    node.as_one_slot = false;
    for (unsigned roots = 2; roots < kSlots; ++roots) node.left_share[roots - 2] = 0;
}

/// The children of the wide node that an inner node becomes.
struct WideChildren {
    BinaryNode* node[kSlots];
    unsigned count = 0;
};
WideChildren children_of(const InnerNode& node);

/// Whether a child is triangles of its parent's slot instead of a node of its own.
inline bool in_one_slot(const BinaryNode& node) {
    return node.is_leaf() || node.inner().as_one_slot;
}

}  // namespace REALCAM_NAMESPACE
