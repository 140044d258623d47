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
    Vec3f axis;  ///< axis of the cone of the lights' normals, unit
    float cos_spread, intensity;  ///< see LightNode
};

/// A light with its bounds, as input of the tree's construction.
struct LightLeaf {
    LightBounds bounds;
    float area;  ///< in m^2; 0 for a point light
    Vec3f centroid;  ///< point by which lights are partitioned
    std::int32_t light = 0;  ///< index among all lights: point lights, then area lights
};

/// Light tree over point and area lights for choosing a light by its contribution to a point (light_tree.hpp). Built on
/// the host; rebuilt from scratch whenever a light moves.
class LightTree {
public:
    /// Returns the bounds of a point light.
    static LightLeaf leaf(const PointLight& p);
    /// Returns the bounds of an area light. `mean`: mean factor by which emission map and vertex colours multiply the
    /// luminance (emission_means).
    static LightLeaf leaf(const AreaLight& a, float mean);
    /// Extends a leaf's bounds to enclose those of the same light at another time.
    static void widen(LightLeaf& leaf, const LightLeaf& at_other_time);

    LightTree() = default;
    /// Builds a tree; `leaves` are the point lights, then the area lights, in the order of their indices.
    LightTree(std::vector<LightLeaf> leaves, Checkpoint& checkpoint);

    // Arrays of InstancesView: light_nodes, leaf_lights, light_trails and leaf_probabilities.
    const std::vector<LightNode>& nodes() const { return nodes_; }
    const std::vector<LeafLight>& leaf_lights() const { return leaf_lights_; }
    const std::vector<std::uint64_t>& trails() const { return trails_; }
    const std::vector<float>& leaf_probabilities() const { return leaf_probabilities_; }

private:
    using Leaves = std::vector<LightLeaf>::iterator;

    /// Minimum and maximum of two vectors by component.
    static Vec3f min_of(Vec3f a, Vec3f b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
    static Vec3f max_of(Vec3f a, Vec3f b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }
    static float coordinate(Vec3f v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

    /// Extends the normal cone of `bounds` to enclose both cones.
    static void widen_cone(LightBounds& bounds, const LightBounds& other);

    /// Returns the bounds that enclose two bounds, with the sum of their intensities.
    static LightBounds united(const LightBounds& a, const LightBounds& b);
    /// Returns the bounds that enclose a range of leaves.
    static LightBounds united(Leaves first, Leaves last);

    static constexpr std::ptrdiff_t kMaxInLeaf = 16;  ///< largest number of lights in a leaf

    /// True if the leaves are triangles of one flat lamp: coplanar, of similar radiance, and adjacent. Choosing among
    /// these by power alone is then as good as any choice. `all`: bounds of all of them.
    static bool is_one_lamp(Leaves first, Leaves last, const LightBounds& all);

    /// Cost of a node: intensity times surface area times the solid angle of its emission (surface area orientation
    /// heuristic, Conty Estevez and Kulla 2018).
    static double cost(const LightBounds& b);

    /// Partitions the leaves along the best axis and returns the first leaf of the second part. Splits at the median if
    /// all centroids coincide, and from a fixed depth on, so that trails fit into 64 bits.
    Leaves split(Leaves first, Leaves last, int depth, Checkpoint& checkpoint) const;

    /// Index of the bin of a leaf's centroid among `bins` bins that divide the interval from `low` of length `size`
    /// along the axis.
    static int bin_of(const LightLeaf& leaf, int axis, float low, float size, int bins);

    /// Returns an inner node with these bounds; the second child is set by the caller.
    static LightNode node_of(const LightBounds& bounds);

    /// Adds the node of these lights and its subtree. `trail`: the path from the root to the node
    /// (InstancesView::light_trails). Returns the node's bounds.
    LightBounds add(Leaves first, Leaves last, std::uint64_t trail, int depth, Checkpoint& checkpoint);
    /// Turns a node into the leaf of these lights, and sets their trails and probabilities.
    void fill_leaf(LightNode& leaf, Leaves first, Leaves last, std::uint64_t trail);

    std::vector<LightNode> nodes_;
    std::vector<LeafLight> leaf_lights_;
    std::vector<std::uint64_t> trails_;
    std::vector<float> leaf_probabilities_;
};

}  // namespace REALCAM_NAMESPACE
