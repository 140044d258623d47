#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "build_wide_bvh.hpp"
#include "quantised_boxes.hpp"

namespace realcam {
namespace {

/// Number of upper levels whose children are refitted as parallel tasks.
constexpr int kParallelLevels = 3;

/// Refits a subtree from the leaves up and returns its bounding box.
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
        for (unsigned left = count_bits(node.content >> (3 * s) & 7u); left > 0; --left) {
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
