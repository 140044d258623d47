#pragma once
#include <span>
#include <vector>

#include "../keep_going.hpp"
#include "../scene/scene_view.hpp"
#include "binary_tree.hpp"
#include "wide_bvh.hpp"

namespace REALCAM_NAMESPACE {

/// The nodes of a hierarchy over anything that has a box, in the order of their depth-first ranges: a node's children
/// come after itself.
struct WideNodes {
    std::vector<WideNode> nodes;       ///< at least one
    std::vector<std::uint32_t> order;  ///< numbers in the caller's list, as the leaves lie one after the other
};

/// Boxes by the caller's number. Otherwise as build_wide_bvh.
WideNodes build_wide_nodes(std::size_t count, const BoxOf& box_of, const KeepGoing& keep_going = {});

/// Makes the nodes those of other boxes, given by their place in the order of leaves; on all threads.
void refit(std::vector<WideNode>& nodes, const BoxOf& box_of_leaf);

/// Owns a hierarchy of triangles.
struct WideBvh {
    struct Corners {
        std::uint32_t vertices[3];
    };

    std::vector<WideNode> nodes;
    std::vector<BvhTriangle> triangles;
    std::vector<Corners> corners;  ///< of each of `triangles`, among the positions: for refit

    WideBvhView view() const { return {nodes.data(), triangles.data()}; }
};

/// A hierarchy over triangles, by the surface area heuristic, on all threads of the calling arena. Positions are
/// finite, their size between 1e-15 and 1e18 or 0. Throws DeviceError where Embree fails (out of memory, for one), or
/// for more than 2^28 triangles; and Cancelled where `keep_going`, asked on any thread, returns false.
WideBvh build_wide_bvh(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                       const KeepGoing& keep_going = {});

/// Moves the triangles to new positions of the same vertices, on all threads. The result is as right as that of a new
/// build, and as fast as long as neighbours stay neighbours.
void refit(WideBvh& bvh, std::span<const Vec3f> positions);

}  // namespace REALCAM_NAMESPACE
