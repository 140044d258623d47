#pragma once
#include <cstddef>
#include <span>

#include "../scene/scene_view.hpp"
#include "quantised_boxes.hpp"

namespace REALCAM_NAMESPACE {

struct InnerNode;

/// A leaf of the binary tree is a BinaryNode by itself, and holds one triangle.
struct BinaryNode {
    Box box;
    std::uint32_t triangles;  ///< below it; 1: a leaf
    std::uint32_t triangle;  ///< a leaf's

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

/// A binary tree over triangles, split where the surface area heuristic says (Embree's builder, on all threads).
/// Boxes and triangle counts of inner nodes are not filled in yet.
class BinaryTree {
public:
    /// Throws DeviceError (out of memory, for one). There is at least one triangle.
    BinaryTree(std::span<const Vec3f> positions, std::span<const Triangle> triangles);
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
