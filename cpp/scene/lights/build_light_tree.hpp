#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "../../checkpoint.hpp"
#include "../scene_view.hpp"

namespace REALCAM_NAMESPACE {

/// Bounds of a group of lights in space, direction and intensity, from which a LightNode is made.
struct LightBounds {
    Vec3f low, high;  ///< bounding box
    Vec3f axis;
    float cos_spread, intensity;  ///< see LightNode
};

/// A light with its bounds, as input of the tree's construction.
struct LightLeaf {
    LightBounds bounds;
    float area;  ///< in m^2; 0 for a point light
    Vec3f middle;  ///< centroid, by which lights are partitioned
    std::int32_t light = 0;  ///< index among all lights: point lights, then area lights
};

/// Light tree, built on the host; rebuilt from scratch whenever a light moves.
class LightTree {
public:
    static LightLeaf leaf(const PointLight& p);
    /// `mean`: mean factor by which emission map and vertex colours multiply the luminance (emission_means).
    static LightLeaf leaf(const AreaLight& a, float mean);
    /// Extends a leaf's bounds to those of the same light at another time.
    static void widen(LightLeaf& leaf, const LightLeaf& elsewhere);

    LightTree() = default;
    /// Builds a tree; `leaves` are the point lights, then the area lights, in the order of their indices.
    LightTree(std::vector<LightLeaf> leaves, Checkpoint& checkpoint);

    const std::vector<LightNode>& nodes() const { return nodes_; }
    const std::vector<LeafLight>& leaf_lights() const { return leaf_lights_; }
    const std::vector<std::uint64_t>& trails() const { return trails_; }
    const std::vector<float>& shares() const { return shares_; }

private:
    using Leaves = std::vector<LightLeaf>::iterator;

    static Vec3f least(Vec3f a, Vec3f b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
    static Vec3f most(Vec3f a, Vec3f b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }
    static float coordinate(Vec3f v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

    /// Extends the normal cone to enclose both cones.
    static void widen(LightBounds& bounds, const LightBounds& other);

    static LightBounds around(const LightBounds& a, const LightBounds& b);
    static LightBounds around(Leaves first, Leaves last);

    static constexpr std::ptrdiff_t kMostInLeaf = 16;

    /// True if the leaves are triangles of one flat lamp: coplanar, of similar radiance, and adjacent. Choosing among
    /// these by power alone is then as good as any choice.
    static bool is_one_lamp(Leaves first, Leaves last, const LightBounds& all);

    /// Cost of a node: intensity times spatial and directional extent (surface area orientation heuristic, Conty
    /// Estevez and Kulla 2018).
    static double cost(const LightBounds& b);

    /// Partitions the leaves along the best axis and returns the first leaf of the second part. Splits at the median if
    /// all centroids coincide, and from a fixed depth on, so that trails fit into 64 bits.
    Leaves split(Leaves first, Leaves last, int depth, Checkpoint& checkpoint) const;

    static int bin_of(const LightLeaf& leaf, int axis, float from, float size, int bins);

    static LightNode node_of(const LightBounds& bounds);

    /// Adds the node of these lights and its subtree. Returns the node's bounds.
    LightBounds add(Leaves first, Leaves last, std::uint64_t turns, int depth, Checkpoint& checkpoint);
    void fill_leaf(LightNode& leaf, Leaves first, Leaves last, std::uint64_t turns);

    std::vector<LightNode> nodes_;
    std::vector<LeafLight> leaf_lights_;
    std::vector<std::uint64_t> trails_;
    std::vector<float> shares_;
};

}  // namespace REALCAM_NAMESPACE
