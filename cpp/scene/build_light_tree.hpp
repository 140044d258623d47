#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "../checkpoint.hpp"
#include "scene_view.hpp"

namespace REALCAM_NAMESPACE {

/// Where lights are, and how they shine: what a LightNode is made of.
struct LightBounds {
    Vec3f low, high;  ///< a box about them
    Vec3f axis;
    float cos_spread, intensity;  ///< as LightNode's
};

/// A light of the tree.
struct LightLeaf {
    LightBounds bounds;
    float area;    ///< square metres; 0: of a point light
    Vec3f middle;  ///< of its place
    std::int32_t light = 0;  ///< its number
};

/// Built on the host, anew whenever a light is put elsewhere.
class LightTree {
public:
    static LightLeaf leaf(const PointLight& p);
    /// `mean`: what a map makes of its luminance.
    static LightLeaf leaf(const AreaLight& a, float mean);
    /// Makes a leaf hold what another one says of the same light elsewhere.
    static void widen(LightLeaf& leaf, const LightLeaf& elsewhere);

    LightTree() = default;
    /// Builds a tree of the point lights, then the area lights, in the order of their numbers.
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

    /// The narrowest cone that is easily found about two.
    static void widen(LightBounds& bounds, const LightBounds& other);

    static LightBounds around(const LightBounds& a, const LightBounds& b);
    static LightBounds around(Leaves first, Leaves last);

    static constexpr std::ptrdiff_t kMostInLeaf = 16;

    /// Whether they are triangles of one flat lamp: in one plane, about as bright, and side by side. A choice
    /// between them by their light alone is as good as any.
    static bool is_one_lamp(Leaves first, Leaves last, const LightBounds& all);

    /// What a split costs: intensity times the spread in space and in direction (the paper's surface area orientation
    /// heuristic).
    static double cost(const LightBounds& b);

    /// Where to split, after sorting along the best axis; the middle where all places are alike, and from a depth on at
    /// which 64 turns would not do.
    Leaves split(Leaves first, Leaves last, int depth, Checkpoint& checkpoint) const;

    static int bin_of(const LightLeaf& leaf, int axis, float from, float size, int bins);

    static LightNode node_of(const LightBounds& bounds);

    /// Adds the node of these lights, and all below it. Returns the bounds that it was made of.
    LightBounds add(Leaves first, Leaves last, std::uint64_t turns, int depth, Checkpoint& checkpoint);
    void fill_leaf(LightNode& leaf, Leaves first, Leaves last, std::uint64_t turns);

    std::vector<LightNode> nodes_;
    std::vector<LeafLight> leaf_lights_;
    std::vector<std::uint64_t> trails_;
    std::vector<float> shares_;
};

}  // namespace REALCAM_NAMESPACE
