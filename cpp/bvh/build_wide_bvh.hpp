#pragma once
#include <span>
#include <vector>

#include "../checkpoint.hpp"
#include "../scene/scene_view.hpp"
#include "binary_tree.hpp"
#include "wide_bvh.hpp"

namespace REALCAM_NAMESPACE {

/// Nodes of a wide BVH over primitives with bounding boxes. Node 0 is the root; children come after their parent, and
/// the nodes of a subtree other than its root are consecutive.
struct WideNodes {
    std::vector<WideNode> nodes;       ///< at least one
    std::vector<std::uint32_t> order;  ///< index of each primitive in the caller's list, in the order of the leaves
};

/// Builds a wide BVH over `count` primitives with the boxes that `box_of` returns; see build_wide_bvh for threads,
/// cancellation and Embree's errors.
WideNodes build_wide_nodes(std::size_t count, const BoxOf& box_of, const KeepGoing& keep_going = {});

/// Recomputes the boxes of all nodes from new boxes of the primitives, on all threads. `box_of_leaf` takes an index
/// into WideNodes::order.
void refit(std::vector<WideNode>& nodes, const BoxOf& box_of_leaf);

/// Wide BVH over triangles, with its memory.
struct WideBvh {
    struct Corners {
        std::uint32_t vertices[3];
    };

    std::vector<WideNode> nodes;
    std::vector<BvhTriangle> triangles;
    std::vector<Corners> corners;  ///< vertex indices of each of `triangles`, for refit

    WideBvhView view() const { return {nodes.data(), triangles.data()}; }
};

/// Builds a wide BVH over triangles by the surface area heuristic, on all threads of the calling arena. Positions are
/// finite; their magnitude is 0 or between 1e-15 and 1e18. Throws DeviceError if Embree fails (out of memory, for
/// example) or for more than 2^28 triangles, and Cancelled if `keep_going`, called on any thread, returns false.
WideBvh build_wide_bvh(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                       const KeepGoing& keep_going = {});

/// Refits the BVH to new positions of the same vertices, on all threads. Hits are as exact as after a new build, and
/// traversal is as fast as long as neighbouring triangles stay neighbours.
void refit(WideBvh& bvh, std::span<const Vec3f> positions);

}  // namespace REALCAM_NAMESPACE
