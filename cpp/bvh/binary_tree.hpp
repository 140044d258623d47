#pragma once
#include <cstddef>
#include <functional>

#include "../checkpoint.hpp"
#include "quantised_boxes.hpp"

namespace REALCAM_NAMESPACE {

struct InnerNode;

/// Returns the bounding box of a primitive, given its index in the caller's list.
using BoxOf = std::function<Box(std::uint32_t)>;

/// Node of the binary tree. A plain BinaryNode is a leaf and holds one primitive: a triangle or an instance. Members
/// are named after triangles, the usual primitives.
struct BinaryNode {
    Box box;
    std::uint32_t triangles;  ///< number of primitives in the subtree; 1 in a leaf
    std::uint32_t triangle;  ///< in a leaf: index of its primitive in the caller's list
    InnerNode* parent;  ///< null in the root

    bool is_leaf() const { return triangles == 1; }
    /// The node as an inner node; it must not be a leaf.
    const InnerNode& inner() const;
    InnerNode& inner();
};

/// Inner node. plan_collapse (collapse.hpp) sets the members from `cost` to `as_one_slot`. Index r - 1 of `cost`, and r
/// - 2 of `left_roots`, is for a subtree that occupies at most r child slots of a wide node.
struct InnerNode : BinaryNode {
    BinaryNode* child[2];
    float cost[kSlots - 1];  ///< least cost of the subtree (surface area heuristic)
    std::uint8_t left_roots[kSlots - 1];  ///< number of the slots that child[0] occupies; 0: as for one slot fewer
    bool as_one_slot;  ///< true: in one slot, the subtree becomes triangles instead of a wide node
    std::uint32_t wide_nodes;  ///< number of wide nodes that the subtree becomes; set by build_wide_nodes
};

inline const InnerNode& BinaryNode::inner() const {
    return static_cast<const InnerNode&>(*this);
}
inline InnerNode& BinaryNode::inner() {
    return static_cast<InnerNode&>(*this);
}

/// Returns half of a box's surface area; in double, because boxes may be 1e18 m wide.
inline double half_area(const Box& box) {
    const Vec3d size = static_cast<Vec3d>(box.upper) - static_cast<Vec3d>(box.lower);
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

/// Binary BVH over primitives, split by the surface area heuristic (Embree's builder, on all threads). The boxes and
/// indices of leaves and the children of inner nodes are set; measure() fills in the other boxes, the triangle counts
/// and the parents.
class BinaryTree {
public:
    /// `triangles`: number of primitives, at least one. Throws DeviceError if Embree fails (out of memory, for
    /// example), and Cancelled if `keep_going`, called on any thread, returns false.
    BinaryTree(std::size_t triangles, const BoxOf& box_of, const KeepGoing& keep_going);
    ~BinaryTree();
    BinaryTree(const BinaryTree&) = delete;
    BinaryTree& operator=(const BinaryTree&) = delete;

    BinaryNode& root() { return *root_; }

private:
    struct Memory;
    Memory* memory_;  ///< owns the nodes
    BinaryNode* root_;
};

/// Rebuilds the subtree of a node with the least depth, ceil(log2(triangles)) levels, by median splits along the axis
/// of the largest extent. Used where the surface area heuristic has produced a chain of nodes that is too deep. Reuses
/// the nodes; measure() must be called again.
void balance(InnerNode& node);

}  // namespace REALCAM_NAMESPACE
