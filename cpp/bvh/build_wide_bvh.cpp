#include "build_wide_bvh.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <string>

#include "../error.hpp"
#include "collapse.hpp"
#include "quantised_boxes.hpp"
#include "reinsertion.hpp"
#include "slot_order.hpp"

namespace realcam {
namespace {

/// Number of levels of wide nodes built by the surface area heuristic. The levels below are built by median splits; a
/// wide node takes up at least one level of them, so that they add at most 28 for the largest scene.
constexpr int kLevelsByArea = 20;
constexpr std::size_t kMaxTriangles = std::size_t{1} << 28;
static_assert(kLevelsByArea + 28 <= kMaxBvhDepth);

/// Least number of triangles for which a subtree gets its own task.
constexpr std::uint32_t kTaskSize = 2048;

/// Counts the wide nodes of the subtree at `node`, so that the range of each subtree is known before it is written.
/// `level`: number of wide nodes above it. Rebuilds subtrees that reach the level kLevelsByArea by median splits.
void count_wide_nodes(InnerNode& node, int level) {
    if (level == kLevelsByArea) {
        balance(node);
        measure(node);
        plan_collapse(node);
        keep_as_node(node);
    }
    const WideChildren children = children_of(node);
    tbb::task_group tasks;
    for (unsigned c = 0; c < children.count; ++c) {
        if (in_one_slot(*children.node[c])) continue;
        InnerNode& child = children.node[c]->inner();
        if (child.triangles >= kTaskSize)
            tasks.run([&child, level] { count_wide_nodes(child, level + 1); });
        else
            count_wide_nodes(child, level + 1);
    }
    tasks.wait();
    node.wide_nodes = 1;
    for (unsigned c = 0; c < children.count; ++c)
        if (!in_one_slot(*children.node[c])) node.wide_nodes += children.node[c]->inner().wide_nodes;
}

/// Writes the wide nodes and the order of the leaves, subtrees in parallel.
class Writer {
public:
    explicit Writer(WideNodes& bvh) : bvh_(bvh) {}

    /// Writes a wide node with these children, and its subtree. `index`: of the node; `first_below` and
    /// `first_triangle`: first indices of the nodes below it and of its triangles.
    void write(const WideChildren& children, std::uint32_t index, std::uint32_t first_below,
               std::uint32_t first_triangle) {
        Box boxes[kSlots] = {};
        unsigned slot_of[kSlots];
        for (unsigned c = 0; c < children.count; ++c) boxes[c] = children.node[c]->box;
        order_slots(boxes, children.count, slot_of);
        const BinaryNode* in_slot[kSlots] = {};
        Box slot_boxes[kSlots] = {};
        unsigned used = 0;
        for (unsigned c = 0; c < children.count; ++c) {
            in_slot[slot_of[c]] = children.node[c];
            slot_boxes[slot_of[c]] = boxes[c];
            used |= 1u << slot_of[c];
        }
        WideNode& node = bvh_.nodes[index];
        node.first_child = first_below;
        node.first_triangle = first_triangle;
        node.content = 0;
        quantise_boxes(node, slot_boxes, used);
        std::uint32_t inner_children = 0;
        for (unsigned s = 0; s < kSlots; ++s) {
            if (!in_slot[s]) continue;
            if (in_one_slot(*in_slot[s])) {
                node.content |= ((1u << in_slot[s]->triangles) - 1) << (3 * s);
                write_triangles(*in_slot[s], first_triangle);
            } else {
                node.content |= 1u << (24 + s);
                ++inner_children;
            }
        }
        std::uint32_t child_index = first_below, below = first_below + inner_children;
        tbb::task_group tasks;
        for (unsigned s = 0; s < kSlots; ++s) {
            if (!in_slot[s] || in_one_slot(*in_slot[s])) continue;
            const InnerNode& child = in_slot[s]->inner();
            const auto descend = [this, &child, child_index, below, first_triangle] {
                write(children_of(child), child_index, below, first_triangle);
            };
            if (child.triangles >= kTaskSize)
                tasks.run(descend);
            else
                descend();
            ++child_index;
            below += child.wide_nodes - 1;
            first_triangle += child.triangles;
        }
        tasks.wait();
    }

private:
    /// Writes the caller's indices of a subtree's primitives from position `next` on, and advances it.
    void write_triangles(const BinaryNode& node, std::uint32_t& next) {
        if (node.is_leaf())
            bvh_.order[next++] = node.triangle;
        else
            for (const BinaryNode* child : node.inner().child) write_triangles(*child, next);
    }

    WideNodes& bvh_;
};

}  // namespace

WideNodes build_wide_nodes(std::size_t count, const BoxOf& box_of, const KeepGoing& keep_going) {
    WideNodes bvh;
    if (count == 0) {
        bvh.nodes.resize(1);
        quantise_boxes(bvh.nodes[0], {}, 0);
        return bvh;
    }
    BinaryTree tree(count, box_of, keep_going);
    BinaryNode& root = tree.root();
    WideChildren top;
    std::uint32_t node_count = 1;
    if (root.is_leaf()) {
        top.node[top.count++] = &root;
    } else {
        measure(root);
        reinsert_largest(root);
        plan_collapse(root);
        count_wide_nodes(root.inner(), 0);
        top = children_of(root.inner());
        node_count = root.inner().wide_nodes;
    }
    bvh.nodes.resize(node_count);
    bvh.order.resize(count);
    Writer(bvh).write(top, 0, 1, 0);
    return bvh;
}

WideBvh build_wide_bvh(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                       const KeepGoing& keep_going) {
    if (triangles.size() > kMaxTriangles)
        throw DeviceError("the scene has " + std::to_string(triangles.size()) + " triangles; a BVH holds at most " +
                          std::to_string(kMaxTriangles));
    const auto bvh_triangle = [&](std::uint32_t index) -> BvhTriangle {
        const std::uint32_t* vertex = triangles[index].vertices;
        return {positions[vertex[0]], index, positions[vertex[1]], 0, positions[vertex[2]], 0};
    };
    WideNodes tree =
        build_wide_nodes(triangles.size(), [&](std::uint32_t i) { return box_of(bvh_triangle(i)); }, keep_going);
    WideBvh bvh;
    bvh.nodes = std::move(tree.nodes);
    bvh.triangles.resize(triangles.size());
    bvh.corners.resize(triangles.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, triangles.size(), 4096), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            bvh.triangles[i] = bvh_triangle(tree.order[i]);
            const std::uint32_t* vertex = triangles[tree.order[i]].vertices;
            bvh.corners[i] = {{vertex[0], vertex[1], vertex[2]}};
        }
    });
    return bvh;
}

namespace {

/// Number of upper levels whose children are refitted as parallel tasks.
constexpr int kParallelLevels = 3;

/// Refits the subtree at node `index`, which is `level` levels below the root, from the leaves up; returns its bounding
/// box.
Box refit_node(std::vector<WideNode>& nodes, const BoxOf& box_of_leaf, std::uint32_t index, int level) {
    WideNode& node = nodes[index];
    Box boxes[kSlots] = {};
    unsigned used = 0;
    std::uint32_t child[kSlots], leaf = node.first_triangle, next_child = node.first_child;
    for (unsigned s = 0; s < kSlots; ++s) {
        if (node.content >> (24 + s) & 1u) {
            child[s] = next_child++;
            used |= 1u << s;
            continue;
        }
        for (unsigned remaining = count_bits(node.content >> (3 * s) & 7u); remaining > 0; --remaining) {
            const Box box = box_of_leaf(leaf++);
            if (used >> s & 1u)
                grow(boxes[s], box);
            else
                boxes[s] = box;
            used |= 1u << s;
        }
    }
    const auto refit_child = [&](unsigned s) {
        if (node.content >> (24 + s) & 1u) boxes[s] = refit_node(nodes, box_of_leaf, child[s], level + 1);
    };
    if (level < kParallelLevels)
        tbb::parallel_for(0u, kSlots, refit_child);
    else
        for (unsigned s = 0; s < kSlots; ++s) refit_child(s);

    quantise_boxes(node, boxes, used);
    Box whole = {};
    bool first = true;
    for (unsigned s = 0; s < kSlots; ++s) {
        if (!(used >> s & 1u)) continue;
        if (first)
            whole = boxes[s];
        else
            grow(whole, boxes[s]);
        first = false;
    }
    return whole;
}

}  // namespace

void refit(std::vector<WideNode>& nodes, const BoxOf& box_of_leaf) {
    refit_node(nodes, box_of_leaf, 0, 0);
}

void refit(WideBvh& bvh, std::span<const Vec3f> positions) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, bvh.triangles.size(), 4096), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            const std::uint32_t* vertex = bvh.corners[i].vertices;
            BvhTriangle& triangle = bvh.triangles[i];
            triangle.a = positions[vertex[0]];
            triangle.b = positions[vertex[1]];
            triangle.c = positions[vertex[2]];
        }
    });
    refit(bvh.nodes, [&](std::uint32_t i) { return box_of(bvh.triangles[i]); });
}

}  // namespace realcam
