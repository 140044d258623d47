#pragma once
#include <cstddef>
#include <functional>

#include "../keep_going.hpp"
#include "quantised_boxes.hpp"

namespace REALCAM_NAMESPACE {

struct InnerNode;

/// The box of something that a hierarchy is built over, by its number in the caller's list.
using BoxOf = std::function<Box(std::uint32_t)>;

/// A leaf of the binary tree is a BinaryNode by itself, and holds one triangle, or whatever else has a box.
struct BinaryNode {
    Box box;
    std::uint32_t triangles;  ///< below it; 1: a leaf
    std::uint32_t triangle;  ///< a leaf's
    InnerNode* parent;  ///< null: the root

    bool is_leaf() const { return triangles == 1; }
    const InnerNode& inner() const;
    InnerNode& inner();
};

/// With room for what collapse.hpp finds out.
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

/// In double, because 1e18 m squared is too much for float.
inline double half_area(const Box& box) {
    const Vec3d size = static_cast<Vec3d>(box.upper) - static_cast<Vec3d>(box.lower);
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

/// A binary tree over triangles, split where the surface area heuristic says (Embree's builder, on all threads).
/// It has not been measured: what inner nodes have besides their children is open, and so are the parents.
class BinaryTree {
public:
    /// Throws DeviceError (out of memory, for one), and Cancelled where `keep_going`, asked on any thread, returns
    /// false. There is at least one triangle.
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

/// Makes the tree below a node as flat as can be, ceil(log2(triangles)) levels, where splitting by area has made a
/// chain of it: halves by number, along the axis of the largest extent. The nodes are used again.
void balance(InnerNode& node);

}  // namespace REALCAM_NAMESPACE
