#pragma once
#include "binary_tree.hpp"

namespace REALCAM_NAMESPACE {

// Selects which nodes of a binary tree become the children of each wide node, so that the total cost by the surface
// area heuristic is least: dynamic programming from the leaves up (Ylitie, Karras and Laine 2017, section 3.1).

/// Cost of a triangle test, relative to that of a wide node with its eight boxes.
inline constexpr float kTriangleCost = 0.5f;

/// Sets the boxes, triangle counts and parents of a subtree from its leaves, in parallel.
void measure(BinaryNode& node);

/// Computes the decisions that children_of follows, for a subtree that measure() has processed; in parallel.
void plan_collapse(BinaryNode& node);

/// Makes a node remain a wide node whose decisions plan_collapse has computed a second time, because its parent's
/// decisions count it as one.
inline void keep_as_node(InnerNode& node) {
    node.as_one_slot = false;
    for (unsigned roots = 2; roots < kSlots; ++roots) node.left_roots[roots - 2] = 0;
}

/// Children of the wide node into which an inner node is collapsed.
struct WideChildren {
    BinaryNode* node[kSlots];
    unsigned count = 0;
};

/// Returns the subtrees, at most eight, that become the slots of the wide node of `node`; follows plan_collapse.
WideChildren children_of(const InnerNode& node);

/// True if a child becomes triangles in a slot of its parent instead of a wide node of its own.
inline bool in_one_slot(const BinaryNode& node) {
    return node.is_leaf() || node.inner().as_one_slot;
}

}  // namespace REALCAM_NAMESPACE
