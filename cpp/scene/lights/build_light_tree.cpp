#include "build_light_tree.hpp"

#include <cmath>

#include "../../math/sampling_tables.hpp"

namespace realcam {

LightLeaf LightTree::leaf(const PointLight& p) {
    const bool is_spot = p.cos_scale > 0;
    // Cosine of the spot's outer cone angle.
    const float cos_spread = is_spot ? std::clamp(-p.cos_offset / p.cos_scale, 0.0f, 1.0f) : kIsotropic;
    return {{p.position, p.position, p.axis, cos_spread, luminance(p.intensity)}, 0.0f, p.position};
}

LightLeaf LightTree::leaf(const AreaLight& a, float mean) {
    const Vec3f b = a.corner + a.edge_u, c = a.corner + a.edge_v;
    return {{least(a.corner, least(b, c)), most(a.corner, most(b, c)), a.normal, a.is_two_sided ? kIsotropic : 1.0f,
             mean * a.area * luminance(a.radiance)},
            a.area,
            (1.0f / 3.0f) * (a.corner + b + c)};
}

void LightTree::widen(LightLeaf& leaf, const LightLeaf& elsewhere) {
    const float intensity = std::max(leaf.bounds.intensity, elsewhere.bounds.intensity);
    leaf.bounds = around(leaf.bounds, elsewhere.bounds);
    leaf.bounds.intensity = intensity;
    leaf.middle = 0.5f * (leaf.bounds.low + leaf.bounds.high);
}

LightTree::LightTree(std::vector<LightLeaf> leaves, Checkpoint& checkpoint) {
    for (std::size_t i = 0; i < leaves.size(); ++i) leaves[i].light = static_cast<std::int32_t>(i);
    trails_.resize(leaves.size());
    shares_.resize(leaves.size());
    if (!leaves.empty()) add(leaves.begin(), leaves.end(), 0, 0, checkpoint);
}

void LightTree::widen(LightBounds& bounds, const LightBounds& other) {
    if (bounds.cos_spread == kIsotropic) return;
    if (other.cos_spread == kIsotropic) {
        bounds.cos_spread = kIsotropic;
        return;
    }
    const double a = std::acos(std::clamp(static_cast<double>(bounds.cos_spread), -1.0, 1.0)),
                 b = std::acos(std::clamp(static_cast<double>(other.cos_spread), -1.0, 1.0));
    const Vec3d u = static_cast<Vec3d>(bounds.axis), v = static_cast<Vec3d>(other.axis);
    const double between = std::atan2(length(cross(u, v)), dot(u, v));
    if (between + b <= a) return;
    if (between + a <= b) {
        bounds.axis = other.axis;
        bounds.cos_spread = other.cos_spread;
        return;
    }
    const double spread = 0.5 * (a + b + between) + 1e-6;
    const Vec3d turned = cross(cross(u, v), u);
    if (spread >= 3.14159 || !(length(turned) > 0)) {
        bounds.cos_spread = -1.0f;
        return;
    }
    const double turn = spread - a;
    bounds.axis = static_cast<Vec3f>(normalized(std::cos(turn) * u + std::sin(turn) * normalized(turned)));
    bounds.cos_spread = static_cast<float>(std::cos(spread));
}

LightBounds LightTree::around(const LightBounds& a, const LightBounds& b) {
    LightBounds all = a;
    all.low = least(a.low, b.low);
    all.high = most(a.high, b.high);
    all.intensity = a.intensity + b.intensity;
    widen(all, b);
    return all;
}

LightBounds LightTree::around(Leaves first, Leaves last) {
    LightBounds all = first->bounds;
    for (Leaves i = first + 1; i != last; ++i) all = around(all, i->bounds);
    return all;
}

bool LightTree::is_one_lamp(Leaves first, Leaves last, const LightBounds& all) {
    constexpr float kMostRatio = 10;  // largest ratio of radiances
    // Least area over the squared diagonal of the bounding box. A disc has 0.39, a square 0.5, a 4:1 rectangle 0.24.
    constexpr float kLeastFilled = 0.2f;
    const auto squared_size = [](const LightBounds& b) { return dot(b.high - b.low, b.high - b.low); };
    float area = 0, largest = 0;
    for (Leaves i = first; i != last; ++i) {
        const LightBounds& one = i->bounds;
        const float ratio = (one.intensity * first->area) / (i->area * first->bounds.intensity);
        if (one.cos_spread == kIsotropic || !(dot(one.axis, first->bounds.axis) > 0.9999f) ||
            !(ratio * kMostRatio > 1.0f && ratio < kMostRatio))
            return false;
        area += i->area;
        largest = std::max(largest, squared_size(one));
    }
    // Each of the two triangles of a rectangle, however long, has the bounding box of the rectangle.
    return area > kLeastFilled * squared_size(all) || squared_size(all) < 1.5f * largest;
}

double LightTree::cost(const LightBounds& b) {
    const Vec3d d = static_cast<Vec3d>(b.high - b.low);
    const double area = d.x * d.y + d.y * d.z + d.z * d.x, size2 = dot(d, d);
    const double spread = b.cos_spread == kIsotropic ? 3.141592653589793 : std::acos(static_cast<double>(b.cos_spread));
    const double end = std::min(spread + 1.5707963267948966, 3.141592653589793), cosine = std::cos(spread);
    const double directions = 6.283185307179586 * (1 - cosine) +
                              1.5707963267948966 * (2 * end * std::sin(spread) - std::cos(spread - 2 * end) -
                                                    2 * spread * std::sin(spread) + cosine);
    return static_cast<double>(b.intensity) * std::max(directions, 1e-3) * (area + 1e-6 * size2);
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
        LightBounds bins[kBins];
        bool filled[kBins] = {};
        for (Leaves i = first; i != last; ++i) {
            checkpoint.pass();
            const int bin = bin_of(*i, axis, from, size, kBins);
            bins[bin] = filled[bin] ? around(bins[bin], i->bounds) : i->bounds;
            filled[bin] = true;
        }
        double after[kBins] = {};
        LightBounds sum{};
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

LightNode LightTree::node_of(const LightBounds& bounds) {
    const Vec3f half = 0.5f * (bounds.high - bounds.low);
    return {0.5f * (bounds.low + bounds.high),
            dot(half, half),
            bounds.axis,
            bounds.cos_spread,
            bounds.intensity,
            0,
            -1,
            1.0f};
}

LightBounds LightTree::add(Leaves first, Leaves last, std::uint64_t turns, int depth, Checkpoint& checkpoint) {
    const std::size_t index = nodes_.size();
    nodes_.emplace_back();
    if (last - first <= kMostInLeaf) {
        const LightBounds all = around(first, last);
        if (last - first == 1 || is_one_lamp(first, last, all)) {
            nodes_[index] = node_of(all);
            fill_leaf(nodes_[index], first, last, turns);
            return all;
        }
    }
    const Leaves middle = split(first, last, depth, checkpoint);
    const LightBounds one = add(first, middle, turns, depth + 1, checkpoint);
    const auto second = static_cast<std::int32_t>(nodes_.size());
    const LightBounds other = add(middle, last, turns | std::uint64_t{1} << depth, depth + 1, checkpoint);
    const LightBounds all = around(one, other);
    nodes_[index] = node_of(all);
    nodes_[index].second_child = second;
    return all;
}

void LightTree::fill_leaf(LightNode& leaf, Leaves first, Leaves last, std::uint64_t turns) {
    std::vector<double> intensities;
    for (Leaves i = first; i != last; ++i) intensities.push_back(static_cast<double>(i->bounds.intensity));
    std::vector<float> cdf;
    append_cdf(intensities, cdf);
    for (std::size_t k = 0; k < intensities.size(); ++k) {
        const auto light = static_cast<std::size_t>(first[static_cast<std::ptrdiff_t>(k)].light);
        trails_[light] = turns;
        shares_[light] = cdf[k + 1] - cdf[k];
    }
    leaf.second_child = -1 - first->light;
    leaf.first_share = cdf[1];
    if (last - first <= 2) {
        leaf.partner = last - first == 2 ? first[1].light : -1;
        return;
    }
    leaf.partner = -2 - static_cast<std::int32_t>(leaf_lights_.size());
    for (std::size_t k = 0; k < intensities.size(); ++k)
        leaf_lights_.push_back({first[static_cast<std::ptrdiff_t>(k)].light, cdf[k]});
    leaf_lights_.push_back({-1, 1.0f});
}

}  // namespace realcam
