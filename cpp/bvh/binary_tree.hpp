#pragma once
#include <cstddef>
#include <functional>

#include "../checkpoint.hpp"
#include "quantised_boxes.hpp"

namespace REALCAM_NAMESPACE {

struct InnerNode;

/// Returns the bounding box of a primitive, given its index in the caller's list.
using BoxOf = std::function<Box(std::uint32_t)>;

/// Node of the binary tree. A plain BinaryNode is a leaf and holds one primitive, such as a triangle or an instance.
struct BinaryNode {
    Box box;
    std::uint32_t triangles;  ///< number in the subtree; 1 in a leaf
    std::uint32_t triangle;  ///< in a leaf: index of its primitive in the caller's list
    InnerNode* parent;  ///< null in the root

    bool is_leaf() const { return triangles == 1; }
    const InnerNode& inner() const;
    InnerNode& inner();
};

/// Inner node, with the members that collapse.hpp fills in.
struct InnerNode : BinaryNode {
    BinaryNode* child[2];
    float cost[kSlots - 1];
    std::uint8_t left_share[kSlots - 1];
    bool as_one_slot;
    std::uint32_t wide_nodes;
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

/// Binary BVH over triangles, split by the surface area heuristic (Embree's builder, on all threads). The boxes and
/// indices of leaves and the children of inner nodes are set; measure() fills in the other boxes, the triangle counts
/// and the parents.
class BinaryTree {
public:
    /// Needs at least one triangle. Throws DeviceError if Embree fails (out of memory, for example), and Cancelled if
    /// `keep_going`, called on any thread, returns false.
    BinaryTree(std::size_t triangles, const BoxOf& box_of, const KeepGoing& keep_going);
    ~BinaryTree();
    BinaryTree(const BinaryTree&) = delete;
    BinaryTree& operator=(const BinaryTree&) = delete;

    BinaryNode& root() { return *root_; }

private:
    struct Memory;
    Memory* memory_;
    BinaryNode* root_;
};

/// Rebuilds the subtree of a node with the least depth, ceil(log2(triangles)) levels, by median splits along the axis
/// of the largest extent; for the chains that the surface area heuristic can produce. Reuses the nodes.
void balance(InnerNode& node);

}  // namespace REALCAM_NAMESPACE
