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
    return {{min_of(a.corner, min_of(b, c)), max_of(a.corner, max_of(b, c)), a.normal,
             a.is_two_sided ? kIsotropic : 1.0f, mean * a.area * luminance(a.radiance)},
            a.area,
            (1.0f / 3.0f) * (a.corner + b + c)};
}

void LightTree::widen(LightLeaf& leaf, const LightLeaf& at_other_time) {
    const float intensity = std::max(leaf.bounds.intensity, at_other_time.bounds.intensity);
    leaf.bounds = united(leaf.bounds, at_other_time.bounds);
    leaf.bounds.intensity = intensity;
    leaf.centroid = 0.5f * (leaf.bounds.low + leaf.bounds.high);
}

LightTree::LightTree(std::vector<LightLeaf> leaves, Checkpoint& checkpoint) {
    for (std::size_t i = 0; i < leaves.size(); ++i) leaves[i].light = static_cast<std::int32_t>(i);
    trails_.resize(leaves.size());
    leaf_probabilities_.resize(leaves.size());
    if (!leaves.empty()) add(leaves.begin(), leaves.end(), 0, 0, checkpoint);
}

void LightTree::widen_cone(LightBounds& bounds, const LightBounds& other) {
    if (bounds.cos_spread == kIsotropic) return;
    if (other.cos_spread == kIsotropic) {
        bounds.cos_spread = kIsotropic;
        return;
    }
    // Half angles of the two cones.
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
    const double spread = 0.5 * (a + b + between) + 1e-6;  // with a margin for rounding
    const Vec3d perpendicular = cross(cross(u, v), u);  // to u, in the plane of u and v
    if (spread >= 3.14159 || !(length(perpendicular) > 0)) {
        bounds.cos_spread = -1.0f;
        return;
    }
    const double rotation = spread - a;  // angle from u to the new axis
    bounds.axis =
        static_cast<Vec3f>(normalized(std::cos(rotation) * u + std::sin(rotation) * normalized(perpendicular)));
    bounds.cos_spread = static_cast<float>(std::cos(spread));
}

LightBounds LightTree::united(const LightBounds& a, const LightBounds& b) {
    LightBounds all = a;
    all.low = min_of(a.low, b.low);
    all.high = max_of(a.high, b.high);
    all.intensity = a.intensity + b.intensity;
    widen_cone(all, b);
    return all;
}

LightBounds LightTree::united(Leaves first, Leaves last) {
    LightBounds all = first->bounds;
    for (Leaves i = first + 1; i != last; ++i) all = united(all, i->bounds);
    return all;
}

bool LightTree::is_one_lamp(Leaves first, Leaves last, const LightBounds& all) {
    constexpr float kMaxRatio = 10;  // largest ratio of radiances
    constexpr float kMinCosine = 0.9999f;  // between the normals of coplanar triangles
    // Least area over the squared diagonal of the bounding box. A disc has 0.39, a square 0.5, a 4:1 rectangle 0.24.
    constexpr float kMinFilled = 0.2f;
    const auto squared_size = [](const LightBounds& b) { return dot(b.high - b.low, b.high - b.low); };
    float area = 0, largest = 0;
    for (Leaves i = first; i != last; ++i) {
        const LightBounds& one = i->bounds;
        const float ratio = (one.intensity * first->area) / (i->area * first->bounds.intensity);
        if (one.cos_spread == kIsotropic || !(dot(one.axis, first->bounds.axis) > kMinCosine) ||
            !(ratio * kMaxRatio > 1.0f && ratio < kMaxRatio))
            return false;
        area += i->area;
        largest = std::max(largest, squared_size(one));
    }
    // The second condition holds for the two triangles of a rectangle, however long: each has the bounding box of the
    // rectangle.
    return area > kMinFilled * squared_size(all) || squared_size(all) < 1.5f * largest;
}

double LightTree::cost(const LightBounds& b) {
    const Vec3d d = static_cast<Vec3d>(b.high - b.low);
    const double area = d.x * d.y + d.y * d.z + d.z * d.x, size2 = dot(d, d);
    constexpr double kPi = 3.141592653589793, kHalfPi = 1.5707963267948966;
    const double spread = b.cos_spread == kIsotropic ? kPi : std::acos(static_cast<double>(b.cos_spread));
    // Solid angle of the normals' cone, and the integral of the emission's cosine around it up to the angle `end`.
    const double end = std::min(spread + kHalfPi, kPi), cosine = std::cos(spread);
    const double directions =
        6.283185307179586 * (1 - cosine) +
        kHalfPi * (2 * end * std::sin(spread) - std::cos(spread - 2 * end) - 2 * spread * std::sin(spread) + cosine);
    // Lower limits, so that the cost of a flat or narrow node is not 0.
    return static_cast<double>(b.intensity) * std::max(directions, 1e-3) * (area + 1e-6 * size2);
}

LightTree::Leaves LightTree::split(Leaves first, Leaves last, int depth, Checkpoint& checkpoint) const {
    constexpr int kBins = 12, kMaxDepth = 40;  // from kMaxDepth on, splits at the median
    Vec3f low = first->centroid, high = low;
    for (Leaves i = first; i != last; ++i) low = min_of(low, i->centroid), high = max_of(high, i->centroid);
    double best = HUGE_VAL;
    int best_axis = -1, best_bin = 0;
    for (int axis = 0; axis < 3 && depth < kMaxDepth; ++axis) {
        const float start = coordinate(low, axis), size = coordinate(high, axis) - start;
        if (!(size > 0)) continue;
        LightBounds bins[kBins];
        bool filled[kBins] = {};
        for (Leaves i = first; i != last; ++i) {
            checkpoint.pass();
            const int bin = bin_of(*i, axis, start, size, kBins);
            bins[bin] = filled[bin] ? united(bins[bin], i->bounds) : i->bounds;
            filled[bin] = true;
        }
        double cost_from[kBins] = {};  // cost of all bins from k on
        LightBounds sum{};
        bool is_filled = false;
        for (int k = kBins - 1; k > 0; --k) {
            if (filled[k]) sum = is_filled ? united(sum, bins[k]) : bins[k], is_filled = true;
            cost_from[k] = is_filled ? cost(sum) : HUGE_VAL;
        }
        is_filled = false;
        for (int k = 0; k + 1 < kBins; ++k) {
            if (filled[k]) sum = is_filled ? united(sum, bins[k]) : bins[k], is_filled = true;
            const double total = is_filled ? cost(sum) + cost_from[k + 1] : HUGE_VAL;
            if (total < best) best = total, best_axis = axis, best_bin = k;
        }
    }
    if (best_axis >= 0) {
        const float start = coordinate(low, best_axis), size = coordinate(high, best_axis) - start;
        const Leaves middle = std::partition(
            first, last, [&](const LightLeaf& l) { return bin_of(l, best_axis, start, size, kBins) <= best_bin; });
        if (middle != first && middle != last) return middle;
    }
    return first + (last - first) / 2;
}

int LightTree::bin_of(const LightLeaf& leaf, int axis, float low, float size, int bins) {
    const float position = (coordinate(leaf.centroid, axis) - low) / size;
    return std::clamp(static_cast<int>(position * static_cast<float>(bins)), 0, bins - 1);
}

LightNode LightTree::node_of(const LightBounds& bounds) {
    const Vec3f half = 0.5f * (bounds.high - bounds.low);
    return {0.5f * (bounds.low + bounds.high),
            dot(half, half),
            bounds.axis,
            bounds.cos_spread,
            bounds.intensity,
            /*second_child=*/0,
            /*partner=*/-1,
            /*first_probability=*/1.0f};
}

LightBounds LightTree::add(Leaves first, Leaves last, std::uint64_t trail, int depth, Checkpoint& checkpoint) {
    const std::size_t index = nodes_.size();
    nodes_.emplace_back();
    if (last - first <= kMaxInLeaf) {
        const LightBounds all = united(first, last);
        if (last - first == 1 || is_one_lamp(first, last, all)) {
            nodes_[index] = node_of(all);
            fill_leaf(nodes_[index], first, last, trail);
            return all;
        }
    }
    const Leaves middle = split(first, last, depth, checkpoint);
    const LightBounds first_bounds = add(first, middle, trail, depth + 1, checkpoint);
    const auto second_child = static_cast<std::int32_t>(nodes_.size());
    const LightBounds second_bounds = add(middle, last, trail | std::uint64_t{1} << depth, depth + 1, checkpoint);
    const LightBounds all = united(first_bounds, second_bounds);
    nodes_[index] = node_of(all);
    nodes_[index].second_child = second_child;
    return all;
}

void LightTree::fill_leaf(LightNode& leaf, Leaves first, Leaves last, std::uint64_t trail) {
    std::vector<double> intensities;
    for (Leaves i = first; i != last; ++i) intensities.push_back(static_cast<double>(i->bounds.intensity));
    std::vector<float> cdf;
    append_cdf(intensities, cdf);
    for (std::size_t k = 0; k < intensities.size(); ++k) {
        const auto light = static_cast<std::size_t>(first[static_cast<std::ptrdiff_t>(k)].light);
        trails_[light] = trail;
        leaf_probabilities_[light] = cdf[k + 1] - cdf[k];
    }
    leaf.second_child = -1 - first->light;
    leaf.first_probability = cdf[1];
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
