#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "binary_tree.hpp"

namespace realcam {
namespace {

void collect(BinaryNode& node, std::vector<BinaryNode*>& leaves, std::vector<InnerNode*>& inner_nodes) {
    if (node.is_leaf()) {
        leaves.push_back(&node);
        return;
    }
    inner_nodes.push_back(&node.inner());
    for (BinaryNode* child : node.inner().child) collect(*child, leaves, inner_nodes);
}

BinaryNode* halves(std::span<BinaryNode*> leaves, InnerNode**& next) {
    if (leaves.size() == 1) return leaves.front();
    Box box = leaves.front()->box;
    for (const BinaryNode* leaf : leaves) grow(box, leaf->box);
    const Vec3f size = box.upper - box.lower;
    const auto axis =
        size.x > size.y ? (size.x > size.z ? &Vec3f::x : &Vec3f::z) : (size.y > size.z ? &Vec3f::y : &Vec3f::z);
    const auto middle = leaves.begin() + static_cast<std::ptrdiff_t>(leaves.size() / 2);
    std::nth_element(leaves.begin(), middle, leaves.end(), [axis](const BinaryNode* a, const BinaryNode* b) {
        return 0.5f * (a->box.lower.*axis) + 0.5f * (a->box.upper.*axis) <
               0.5f * (b->box.lower.*axis) + 0.5f * (b->box.upper.*axis);
    });
    InnerNode* node = *next++;
    node->child[0] = halves({leaves.begin(), middle}, next);
    node->child[1] = halves({middle, leaves.end()}, next);
    return node;
}

}  // namespace

void balance(InnerNode& node) {
    std::vector<BinaryNode*> leaves;
    std::vector<InnerNode*> inner_nodes;
    collect(node, leaves, inner_nodes);
    InnerNode** next = inner_nodes.data();  // the first one is `node`
    halves(leaves, next);
}

}  // namespace realcam
