#include "build_light_tree.hpp"
#include "instance_names.hpp"

#include <cmath>

namespace realcam {

LightLeaf LightTree::leaf(const PointLight& p) {
    const bool is_spot = p.cos_scale > 0;
    // Where a spot ends.
    const float cos_spread = is_spot ? std::clamp(-p.cos_offset / p.cos_scale, 0.0f, 1.0f) : -1.0f;
    return {{p.position, p.position, p.axis, cos_spread, luminance(p.intensity), 0, !is_spot, -1, 1.0f}, p.position};
}

LightLeaf LightTree::leaf(const AreaLight& a, float mean) {
    const Vec3f b = a.corner + a.edge_u, c = a.corner + a.edge_v;
    return {{least(a.corner, least(b, c)), most(a.corner, most(b, c)), a.normal, 1.0f,
             mean * a.area * luminance(a.radiance), 0, a.is_two_sided, -1, 1.0f},
            (1.0f / 3.0f) * (a.corner + b + c)};
}

void LightTree::widen(LightLeaf& leaf, const LightLeaf& elsewhere) {
    const float intensity = std::max(leaf.node.intensity, elsewhere.node.intensity);
    leaf.node = around(leaf.node, elsewhere.node);
    leaf.node.intensity = intensity;
    leaf.middle = 0.5f * (leaf.node.low + leaf.node.high);
}

LightTree::LightTree(std::vector<LightLeaf> leaves, Checkpoint& checkpoint) {
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        leaves[i].light = static_cast<std::int32_t>(i);
        leaves[i].node.second_child = -1 - leaves[i].light;
    }
    trails_.resize(leaves.size());
    nodes_.reserve(2 * leaves.size());
    if (!leaves.empty()) add(leaves.begin(), leaves.end(), 0, 0, checkpoint);
}

void LightTree::widen(LightNode& node, const LightNode& other) {
    if (other.is_isotropic) node.is_isotropic = 1;
    const double a = std::acos(std::clamp(static_cast<double>(node.cos_spread), -1.0, 1.0)),
                 b = std::acos(std::clamp(static_cast<double>(other.cos_spread), -1.0, 1.0));
    const Vec3d u = static_cast<Vec3d>(node.axis), v = static_cast<Vec3d>(other.axis);
    const double between = std::atan2(length(cross(u, v)), dot(u, v));
    if (between + b <= a) return;
    if (between + a <= b) {
        node.axis = other.axis;
        node.cos_spread = other.cos_spread;
        return;
    }
    const double spread = 0.5 * (a + b + between) + 1e-6;
    const Vec3d turned = cross(cross(u, v), u);
    if (spread >= 3.14159 || !(length(turned) > 0)) {
        node.cos_spread = -1.0f;
        return;
    }
    const double turn = spread - a;
    node.axis = static_cast<Vec3f>(normalized(std::cos(turn) * u + std::sin(turn) * normalized(turned)));
    node.cos_spread = static_cast<float>(std::cos(spread));
}

LightNode LightTree::around(const LightNode& a, const LightNode& b) {
    LightNode node = a;
    node.low = least(a.low, b.low);
    node.high = most(a.high, b.high);
    node.intensity = a.intensity + b.intensity;
    node.partner = -1;
    widen(node, b);
    return node;
}

bool LightTree::are_alike(const LightNode& a, const LightNode& b) {
    const float ratio = a.intensity / b.intensity;
    return !a.is_isotropic && !b.is_isotropic && dot(a.axis, b.axis) > 0.9999f && ratio > 0.1f && ratio < 10.0f;
}

double LightTree::cost(const LightNode& n) {
    const Vec3d d = static_cast<Vec3d>(n.high - n.low);
    const double area = d.x * d.y + d.y * d.z + d.z * d.x, size2 = dot(d, d);
    const double spread = n.is_isotropic ? 3.141592653589793 : std::acos(static_cast<double>(n.cos_spread));
    const double end = std::min(spread + 1.5707963267948966, 3.141592653589793), cosine = std::cos(spread);
    const double directions = 6.283185307179586 * (1 - cosine) +
                              1.5707963267948966 * (2 * end * std::sin(spread) - std::cos(spread - 2 * end) -
                                                    2 * spread * std::sin(spread) + cosine);
    return static_cast<double>(n.intensity) * std::max(directions, 1e-3) * (area + 1e-6 * size2);
}

LightTree::Leaves LightTree::split(Leaves first, Leaves last, int depth, Checkpoint& checkpoint) const {
    constexpr int kBins = 12, kDeepest = 40;
    Vec3f low = first->middle, high = low;
    for (Leaves i = first; i != last; ++i) low = least(low, i->middle), high = most(high, i->middle);
    double best = HUGE_VAL;
    int best_axis = -1, best_bin = 0;
    for (int axis = 0; axis < 3 && depth < kDeepest; ++axis) {
        const float from = coordinate(low, axis), size = coordinate(high, axis) - from;
        if (!(size > 0)) continue;
        LightNode bins[kBins];
        bool filled[kBins] = {};
        for (Leaves i = first; i != last; ++i) {
            checkpoint.pass();
            const int bin = bin_of(*i, axis, from, size, kBins);
            bins[bin] = filled[bin] ? around(bins[bin], i->node) : i->node;
            filled[bin] = true;
        }
        double after[kBins] = {};
        LightNode sum{};
        bool any = false;
        for (int k = kBins - 1; k > 0; --k) {
            if (filled[k]) sum = any ? around(sum, bins[k]) : bins[k], any = true;
            after[k] = any ? cost(sum) : HUGE_VAL;
        }
        any = false;
        for (int k = 0; k + 1 < kBins; ++k) {
            if (filled[k]) sum = any ? around(sum, bins[k]) : bins[k], any = true;
            const double total = any ? cost(sum) + after[k + 1] : HUGE_VAL;
            if (total < best) best = total, best_axis = axis, best_bin = k;
        }
    }
    if (best_axis >= 0) {
        const float from = coordinate(low, best_axis), size = coordinate(high, best_axis) - from;
        const Leaves middle = std::partition(
            first, last, [&](const LightLeaf& l) { return bin_of(l, best_axis, from, size, kBins) <= best_bin; });
        if (middle != first && middle != last) return middle;
    }
    return first + (last - first) / 2;
}

int LightTree::bin_of(const LightLeaf& leaf, int axis, float from, float size, int bins) {
    const float share = (coordinate(leaf.middle, axis) - from) / size;
    return std::clamp(static_cast<int>(share * static_cast<float>(bins)), 0, bins - 1);
}

LightNode LightTree::add(Leaves first, Leaves last, std::uint64_t turns, int depth, Checkpoint& checkpoint) {
    const std::size_t place = nodes_.size();
    nodes_.push_back(first->node);
    if (last - first == 1) {
        trails_[static_cast<std::size_t>(first->light)] = turns;
        return first->node;
    }
    if (last - first == 2 && are_alike(first->node, first[1].node)) {
        trails_[static_cast<std::size_t>(first->light)] = trails_[static_cast<std::size_t>(first[1].light)] = turns;
        LightNode pair = around(first->node, first[1].node);
        pair.partner = first[1].light;
        pair.first_share = pair.intensity > 0 ? first->node.intensity / pair.intensity : 0.5f;
        return nodes_[place] = pair;
    }
    const Leaves middle = split(first, last, depth, checkpoint);
    const LightNode one = add(first, middle, turns, depth + 1, checkpoint);
    const auto second = static_cast<std::int32_t>(nodes_.size());
    const LightNode other = add(middle, last, turns | std::uint64_t{1} << depth, depth + 1, checkpoint);
    LightNode& node = nodes_[place] = around(one, other);
    node.second_child = second;
    return node;
}

}  // namespace realcam
