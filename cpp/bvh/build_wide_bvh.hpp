#pragma once
#include <span>
#include <vector>

#include "../scene/scene_view.hpp"
#include "wide_bvh.hpp"

namespace REALCAM_NAMESPACE {

/// Owns a hierarchy. Nodes and triangles lie in the order of their depth-first ranges: a node's children and triangles
/// come after itself.
struct WideBvh {
    struct Corners {
        std::uint32_t vertices[3];
    };

    std::vector<WideNode> nodes;  ///< at least one
    std::vector<BvhTriangle> triangles;
    std::vector<Corners> corners;  ///< of each of `triangles`, among the positions: for refit

    WideBvhView view() const { return {nodes.data(), triangles.data()}; }
};

/// A hierarchy over triangles, by the surface area heuristic, on all threads of the calling arena. Positions are
/// finite, their size between 1e-15 and 1e18 or 0. Throws DeviceError where Embree fails (out of memory, for one), or
/// for more than 2^28 triangles.
WideBvh build_wide_bvh(std::span<const Vec3f> positions, std::span<const Triangle> triangles);

/// Moves the triangles to new positions of the same vertices, on all threads. The result is as right as that of a new
/// build, and as fast as long as neighbours stay neighbours.
void refit(WideBvh& bvh, std::span<const Vec3f> positions);

}  // namespace REALCAM_NAMESPACE
