#include "collapse.hpp"

#include <tbb/parallel_invoke.h>

namespace realcam {
namespace {

/// Number of upper levels whose two subtrees are processed as parallel tasks.
constexpr int kParallelLevels = 12;

/// Calls visit(inner_node) for each inner node of a subtree, children before their parents; subtrees in parallel.
template <class Visit>
void bottom_up(BinaryNode& node, int level, const Visit& visit) {
    if (node.is_leaf()) return;
    BinaryNode &left = *node.inner().child[0], &right = *node.inner().child[1];
    if (level < kParallelLevels) {
        tbb::parallel_invoke([&] { bottom_up(left, level + 1, visit); }, [&] { bottom_up(right, level + 1, visit); });
    } else {
        bottom_up(left, level + 1, visit);
        bottom_up(right, level + 1, visit);
    }
    visit(node.inner());
}

/// Dynamic programming over the number of child slots ("roots") of a wide node that a subtree occupies.
struct CollapsePlanner {
    double per_area;  ///< inverse half area of the root, which is the unit of all costs

    float area_of(const BinaryNode& node) const { return static_cast<float>(half_area(node.box) * per_area); }

    /// Returns the least cost of a subtree that occupies at most `roots` child slots of a wide node.
    float cost(const BinaryNode& node, unsigned roots) const {
        return node.is_leaf() ? kTriangleCost * area_of(node) : node.inner().cost[roots - 1];
    }

    /// Sets the costs and decisions of a node whose children have theirs.
    void plan(InnerNode& node) const {
        float left[kSlots], right[kSlots];
        for (unsigned i = 1; i < kSlots; ++i) {
            left[i] = cost(*node.child[0], i);
            right[i] = cost(*node.child[1], i);
        }
        const float area = area_of(node);
        float split_cost[kSlots + 1];
        for (unsigned roots = 2; roots <= kSlots; ++roots) {
            split_cost[roots] = left[1] + right[roots - 1];
            node.left_roots[roots - 2] = 1;
            for (unsigned left_count = 2; left_count < roots; ++left_count) {
                const float c = left[left_count] + right[roots - left_count];
                if (!(c < split_cost[roots])) continue;
                split_cost[roots] = c;
                node.left_roots[roots - 2] = static_cast<std::uint8_t>(left_count);
            }
        }
        const float as_node = split_cost[kSlots] + area;
        const float as_slot = kTriangleCost * area * static_cast<float>(node.triangles);
        node.as_one_slot = node.triangles <= kTrianglesPerSlot && as_slot <= as_node;
        node.cost[0] = node.as_one_slot ? as_slot : as_node;
        for (unsigned roots = 2; roots < kSlots; ++roots) {
            const bool split = split_cost[roots] < node.cost[roots - 2];
            node.cost[roots - 1] = split ? split_cost[roots] : node.cost[roots - 2];
            if (!split) node.left_roots[roots - 2] = 0;  // 0: decided as for one root fewer
        }
    }
};

/// Appends the roots of the subtrees into which a node is divided if it occupies at most `roots` slots of a wide node.
void gather(BinaryNode& node, unsigned roots, WideChildren& children);

/// Divides an inner node into `roots` roots, at least two, and appends these.
void gather_split(const InnerNode& node, unsigned roots, WideChildren& children) {
    const unsigned left_count = node.left_roots[roots - 2];
    gather(*node.child[0], left_count, children);
    gather(*node.child[1], roots - left_count, children);
}

void gather(BinaryNode& node, unsigned roots, WideChildren& children) {
    if (!node.is_leaf())
        while (roots > 1 && node.inner().left_roots[roots - 2] == 0) --roots;
    if (node.is_leaf() || roots == 1)
        children.node[children.count++] = &node;
    else
        gather_split(node.inner(), roots, children);
}

}  // namespace

void measure(BinaryNode& root) {
    bottom_up(root, 0, [](InnerNode& node) {
        node.box = node.child[0]->box;
        grow(node.box, node.child[1]->box);
        node.triangles = node.child[0]->triangles + node.child[1]->triangles;
        node.child[0]->parent = node.child[1]->parent = &node;
    });
}

void plan_collapse(BinaryNode& root) {
    const double area = half_area(root.box);
    const CollapsePlanner planner{area > 0 ? 1 / area : 0};
    bottom_up(root, 0, [&](InnerNode& node) { planner.plan(node); });
}

WideChildren children_of(const InnerNode& node) {
    WideChildren children;
    gather_split(node, kSlots, children);
    return children;
}

}  // namespace realcam
