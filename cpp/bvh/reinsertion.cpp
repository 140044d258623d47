#include "reinsertion.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "binary_tree.hpp"

namespace realcam {
namespace {

// Each round moves one node per kTrianglesPerMove triangles, which is one in sixty nodes, and at most kMaxMoves. That
// achieves all but a few percent of the gain of moving every node, which would take longer than building the tree.
constexpr std::size_t kTrianglesPerMove = 32;
constexpr std::size_t kMaxMoves = 1 << 15;
constexpr int kRounds = 3;
/// Limit on the nodes visited in search of one insertion point: thirty are usual, but in some scenes everything
/// overlaps.
constexpr int kMaxVisited = 512;

Box union_of(Box a, const Box& b) {
    grow(a, b);
    return a;
}

bool has_smaller_box(const BinaryNode* a, const BinaryNode* b) {
    return half_area(a->box) < half_area(b->box);
}

/// Recomputes boxes and triangle counts from a node up to the root.
void measure_upwards(InnerNode* node) {
    for (; node; node = node->parent) {
        node->box = union_of(node->child[0]->box, node->child[1]->box);
        node->triangles = node->child[0]->triangles + node->child[1]->triangles;
    }
}

class Reinsertion {
public:
    explicit Reinsertion(BinaryNode& root) : root_(root) {}

    /// Moves the `count` nodes with the largest boxes.
    void round(std::size_t count) {
        find_largest(count);
        for (BinaryNode* node : largest_) reinsert(*node);
    }

private:
    /// Finds the `count` nodes with the largest boxes. A node's box is at least as large as those of its children, so
    /// that a search from the root finds them in order.
    void find_largest(std::size_t count) {
        largest_.clear();
        std::vector<BinaryNode*> heap = {&root_};
        while (!heap.empty() && largest_.size() < count) {
            std::pop_heap(heap.begin(), heap.end(), has_smaller_box);
            BinaryNode* node = heap.back();
            heap.pop_back();
            largest_.push_back(node);
            if (node->is_leaf()) continue;
            for (BinaryNode* child : node->inner().child) {
                heap.push_back(child);
                std::push_heap(heap.begin(), heap.end(), has_smaller_box);
            }
        }
    }

    /// Removes a node together with its parent, which the sibling replaces, and inserts both where the boxes grow
    /// least.
    void reinsert(BinaryNode& node) {
        InnerNode* parent = node.parent;
        if (!parent || !parent->parent) return;  // the root stays the root
        BinaryNode* sibling = parent->child[parent->child[0] == &node ? 1 : 0];
        double gain = half_area(parent->box);
        replace(parent, sibling);
        for (InnerNode* above = sibling->parent; above; above = above->parent) {
            const Box without = union_of(above->child[0]->box, above->child[1]->box);
            gain += half_area(above->box) - half_area(without);
            above->box = without;
            above->triangles -= node.triangles;
        }
        BinaryNode* new_sibling = best_sibling(node, sibling, gain);
        replace(new_sibling, parent);
        parent->child[0] = new_sibling;
        parent->child[1] = &node;
        new_sibling->parent = node.parent = parent;
        measure_upwards(parent);
    }

    /// Makes `replacement` the child of the node's parent in the node's stead.
    static void replace(BinaryNode* node, BinaryNode* replacement) {
        InnerNode* above = node->parent;
        above->child[above->child[0] == node ? 0 : 1] = replacement;
        replacement->parent = above;
    }

    /// Returns the new sibling for `node` that adds the least area to the tree. `known`: a possible sibling, which
    /// would add `known_cost`. Best-first search: below a node the cost is at least what its ancestors grow by, plus
    /// the area of `node` for the new parent.
    BinaryNode* best_sibling(const BinaryNode& node, BinaryNode* known, double known_cost) {
        const double own = half_area(node.box);
        BinaryNode* best = known;
        double best_cost = known_cost;
        const auto costs_more = [](const Candidate& a, const Candidate& b) { return a.growth_above > b.growth_above; };
        queue_.assign(1, {0, &root_});
        for (int visited = 0; !queue_.empty() && visited < kMaxVisited; ++visited) {
            std::pop_heap(queue_.begin(), queue_.end(), costs_more);
            const Candidate candidate = queue_.back();
            queue_.pop_back();
            if (candidate.growth_above + own >= best_cost) break;
            const double joined = half_area(union_of(candidate.node->box, node.box));
            const double cost = candidate.growth_above + joined;
            if (cost < best_cost && candidate.node != &root_) {
                best_cost = cost;
                best = candidate.node;
            }
            const double growth = cost - half_area(candidate.node->box);
            if (candidate.node->is_leaf() || growth + own >= best_cost) continue;
            for (BinaryNode* child : candidate.node->inner().child) {
                queue_.push_back({growth, child});
                std::push_heap(queue_.begin(), queue_.end(), costs_more);
            }
        }
        return best;
    }

    struct Candidate {
        double growth_above;  ///< half area by which the ancestors of `node` would grow
        BinaryNode* node;
    };

    BinaryNode& root_;
    std::vector<BinaryNode*> largest_;  ///< result of find_largest
    std::vector<Candidate> queue_;  ///< heap of best_sibling
};

}  // namespace

void reinsert_largest(BinaryNode& root) {
    Reinsertion reinsertion(root);
    const std::size_t count = std::min(root.triangles / kTrianglesPerMove + 16, kMaxMoves);
    for (int i = 0; i < kRounds; ++i) reinsertion.round(count);
}

namespace {

/// Appends the leaves and the inner nodes of a subtree, itself first.
void collect_nodes(BinaryNode& node, std::vector<BinaryNode*>& leaves, std::vector<InnerNode*>& inner_nodes) {
    if (node.is_leaf()) {
        leaves.push_back(&node);
        return;
    }
    inner_nodes.push_back(&node.inner());
    for (BinaryNode* child : node.inner().child) collect_nodes(*child, leaves, inner_nodes);
}

/// Builds a tree over the leaves by median splits, from the inner nodes at `next`, which is advanced; returns its root.
BinaryNode* split_at_median(std::span<BinaryNode*> leaves, InnerNode**& next) {
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
    node->child[0] = split_at_median({leaves.begin(), middle}, next);
    node->child[1] = split_at_median({middle, leaves.end()}, next);
    return node;
}

}  // namespace

void balance(InnerNode& node) {
    std::vector<BinaryNode*> leaves;
    std::vector<InnerNode*> inner_nodes;
    collect_nodes(node, leaves, inner_nodes);
    InnerNode** next = inner_nodes.data();  // the first one is `node`
    split_at_median(leaves, next);
}

}  // namespace realcam
