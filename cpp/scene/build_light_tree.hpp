#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "../checkpoint.hpp"
#include "scene_view.hpp"

namespace REALCAM_NAMESPACE {

/// A light, as a leaf of the tree.
struct LightLeaf {
    LightNode node;
    Vec3f middle;
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
    const std::vector<std::uint64_t>& trails() const { return trails_; }

private:
    using Leaves = std::vector<LightLeaf>::iterator;

    static Vec3f least(Vec3f a, Vec3f b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
    static Vec3f most(Vec3f a, Vec3f b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }
    static float coordinate(Vec3f v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

    /// The narrowest cone that is easily found about two.
    static void widen(LightNode& node, const LightNode& other);

    static LightNode around(const LightNode& a, const LightNode& b);

    /// In one plane, and about as bright: a choice between them by their light alone is as good as any.
    static bool are_alike(const LightNode& a, const LightNode& b);

    /// What a split costs: intensity times the spread in space and in direction (the paper's surface area orientation
    /// heuristic).
    static double cost(const LightNode& n);

    /// Where to split, after sorting along the best axis; the middle where all places are alike, and from a depth on at
    /// which 64 turns would not do.
    Leaves split(Leaves first, Leaves last, int depth, Checkpoint& checkpoint) const;

    static int bin_of(const LightLeaf& leaf, int axis, float from, float size, int bins);

    LightNode add(Leaves first, Leaves last, std::uint64_t turns, int depth, Checkpoint& checkpoint);

    std::vector<LightNode> nodes_;
    std::vector<std::uint64_t> trails_;
};

}  // namespace REALCAM_NAMESPACE
