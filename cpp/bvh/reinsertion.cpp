#include "reinsertion.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "binary_tree.hpp"

namespace realcam {
namespace {

// Moving one in sixty nodes achieves all but a few percent of the gain of moving every node, which would take longer
// than building the tree.
constexpr std::size_t kTrianglesForEach = 32;
constexpr std::size_t kMostMoved = 1 << 15;
constexpr int kRounds = 3;
/// Limit on the nodes visited in search of one insertion point: thirty are usual, but in some scenes everything
/// overlaps.
constexpr int kMostVisited = 512;

Box both(Box a, const Box& b) {
    grow(a, b);
    return a;
}

bool smaller(const BinaryNode* a, const BinaryNode* b) {
    return half_area(a->box) < half_area(b->box);
}

/// Recomputes boxes and triangle counts from a node up to the root.
void measure_upwards(InnerNode* node) {
    for (; node; node = node->parent) {
        node->box = both(node->child[0]->box, node->child[1]->box);
        node->triangles = node->child[0]->triangles + node->child[1]->triangles;
    }
}

class Reinsertion {
public:
    explicit Reinsertion(BinaryNode& root) : root_(root) {}

    void round(std::size_t count) {
        find_largest(count);
        for (BinaryNode* node : largest_) move(*node);
    }

private:
    /// Finds the `count` nodes with the largest boxes. A node's box is at least as large as those of its children, so
    /// that a search from the root finds them in order.
    void find_largest(std::size_t count) {
        largest_.clear();
        std::vector<BinaryNode*> heap = {&root_};
        while (!heap.empty() && largest_.size() < count) {
            std::pop_heap(heap.begin(), heap.end(), smaller);
            BinaryNode* node = heap.back();
            heap.pop_back();
            largest_.push_back(node);
            if (node->is_leaf()) continue;
            for (BinaryNode* child : node->inner().child) {
                heap.push_back(child);
                std::push_heap(heap.begin(), heap.end(), smaller);
            }
        }
    }

    /// Removes a node together with its parent, which the sibling replaces, and inserts both where the boxes grow
    /// least.
    void move(BinaryNode& node) {
        InnerNode* parent = node.parent;
        if (!parent || !parent->parent) return;  // the root stays the root
        BinaryNode* sibling = parent->child[parent->child[0] == &node ? 1 : 0];
        double gain = half_area(parent->box);
        replace(parent, sibling);
        for (InnerNode* above = sibling->parent; above; above = above->parent) {
            const Box without = both(above->child[0]->box, above->child[1]->box);
            gain += half_area(above->box) - half_area(without);
            above->box = without;
            above->triangles -= node.triangles;
        }
        BinaryNode* beside = best_position(node, sibling, gain);
        replace(beside, parent);
        parent->child[0] = beside;
        parent->child[1] = &node;
        beside->parent = node.parent = parent;
        measure_upwards(parent);
    }

    static void replace(BinaryNode* node, BinaryNode* by) {
        InnerNode* above = node->parent;
        above->child[above->child[0] == node ? 0 : 1] = by;
        by->parent = above;
    }

    /// Returns the new sibling for `node` that adds the least area; `known` would add `known_cost`. Best-first search:
    /// below a node the cost is at least what its ancestors grow by, plus the area of `node` for the new parent.
    BinaryNode* best_position(const BinaryNode& node, BinaryNode* known, double known_cost) {
        const double own = half_area(node.box);
        BinaryNode* best = known;
        double best_cost = known_cost;
        const auto dearer = [](const Candidate& a, const Candidate& b) { return a.growth_above > b.growth_above; };
        queue_.assign(1, {0, &root_});
        for (int visited = 0; !queue_.empty() && visited < kMostVisited; ++visited) {
            std::pop_heap(queue_.begin(), queue_.end(), dearer);
            const Candidate candidate = queue_.back();
            queue_.pop_back();
            if (candidate.growth_above + own >= best_cost) break;
            const double joined = half_area(both(candidate.node->box, node.box));
            const double cost = candidate.growth_above + joined;
            if (cost < best_cost && candidate.node != &root_) {
                best_cost = cost;
                best = candidate.node;
            }
            const double growth = cost - half_area(candidate.node->box);
            if (candidate.node->is_leaf() || growth + own >= best_cost) continue;
            for (BinaryNode* child : candidate.node->inner().child) {
                queue_.push_back({growth, child});
                std::push_heap(queue_.begin(), queue_.end(), dearer);
            }
        }
        return best;
    }

    struct Candidate {
        double growth_above;
        BinaryNode* node;
    };

    BinaryNode& root_;
    std::vector<BinaryNode*> largest_;
    std::vector<Candidate> queue_;
};

}  // namespace

void reinsert_largest(BinaryNode& root) {
    Reinsertion reinsertion(root);
    const std::size_t count = std::min(root.triangles / kTrianglesForEach + 16, kMostMoved);
    for (int i = 0; i < kRounds; ++i) reinsertion.round(count);
}

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
