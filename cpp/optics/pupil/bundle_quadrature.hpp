#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "../../math/gauss_legendre.hpp"
#include "../../math/vec3.hpp"
#include "../trace/ray_loop.hpp"

namespace REALCAM_NAMESPACE {

/// How many rays an integral over a bundle takes: spokes about the middle of what passes, and Gauss's nodes on each.
struct BundleSampling {
    int spokes, nodes;
};

/// A ray of an integral over the light, by its place in the plane in which the bundle is even.
struct EntryPart {
    Vec2<double> entry;
    double area;  ///< in the units of the entry, squared
};

/// A part of a spoke on which light passes, by its distances from the spokes' middle in units of the bundle's reach.
struct Stretch {
    double from, to;
};

namespace bundle_quadrature_detail {

/// One line from the middle of the light outwards, in units of the bundle's reach, and where the lens lets light pass
/// on it.
template <class Bundle>
class Spoke {
public:
    Spoke(const Bundle& bundle, double angle) : bundle_(bundle), cos_(std::cos(angle)), sin_(std::sin(angle)) {}

    Vec2<double> at(double r) const {
        return {bundle_.middle.x + r * cos_ * bundle_.reach.x, bundle_.middle.y + r * sin_ * bundle_.reach.y};
    }

    /// Looks at steps of a twentieth of the reach; edges are found within 1e-9 of it.
    std::vector<Stretch> stretches() const {
        Vec2<double> entries[kSteps];
        bool passes[kSteps];
        for (int i = 0; i < kSteps; ++i) entries[i] = at(i * kStep);
        bundle_.pass(entries, passes);
        std::vector<Stretch> found;
        if (passes[0]) found.push_back({0, 0});
        for (int i = 1; i < kSteps; ++i) {
            if (passes[i] == passes[i - 1]) continue;
            const double place = edge((i - 1) * kStep, i * kStep, passes[i]);
            if (passes[i])
                found.push_back({place, place});
            else
                found.back().to = place;
        }
        if (passes[kSteps - 1]) found.back().to = (kSteps - 1) * kStep;
        return found;
    }

private:
    static constexpr int kSteps = 35;
    static constexpr double kStep = 1.0 / 20;  // so to 1.7: past the corners of the rectangle

    /// By quarters, between a place that is like the step before it and one that is like the step beyond.
    double edge(double low, double high, bool beyond) const {
        while (high - low > 1e-9) {
            Vec2<double> entries[3];
            bool passes[3];
            const double part = 0.25 * (high - low);
            for (int i = 0; i < 3; ++i) entries[i] = at(low + (i + 1) * part);
            bundle_.pass(entries, passes);
            low += static_cast<double>(std::find(passes, passes + 3, beyond) - passes) * part;
            high = low + part;
        }
        return 0.5 * (low + high);
    }

    const Bundle& bundle_;
    double cos_, sin_;
};

}  // namespace bundle_quadrature_detail

/// A spoke over the light, and where on it light passes.
struct LitSpoke {
    double cos, sin;
    std::vector<Stretch> stretches;

    template <class Bundle>
    Vec2<double> at(const Bundle& bundle, double r) const {
        return {bundle.middle.x + r * cos * bundle.reach.x, bundle.middle.y + r * sin * bundle.reach.y};
    }
};

/// Spokes at even angles over the light, in the order of their angles from -90 degrees on. If a bundle is its own
/// mirror image, only the half of x > 0 is taken; `count` is that of the whole.
template <class Bundle>
std::vector<LitSpoke> lit_spokes(const Bundle& bundle, int count, const RayLoop& loop = {}) {
    using namespace bundle_quadrature_detail;
    const std::size_t half = static_cast<std::size_t>(count + 1) / 2, spokes = bundle.mirrored ? half : 2 * half;
    const double between = std::numbers::pi / static_cast<double>(half);
    std::vector<LitSpoke> lit(spokes);
    loop.for_all(spokes, [&](std::size_t first, std::size_t last) {
        for (std::size_t s = first; s < last; ++s) {
            const double angle = between * (static_cast<double>(s) + 0.5) - 0.5 * std::numbers::pi;
            lit[s] = {std::cos(angle), std::sin(angle), Spoke(bundle, angle).stretches()};
        }
    });
    return lit;
}

/// A rectangle in the plane in which a bundle is even.
struct EntryRectangle {
    Vec2<double> middle, reach;  ///< half its sides
};

/// A rectangle that holds all light of a bundle: its own, and what stands out of that by the edges on spokes. Between
/// two of 128 spokes a corner of the light stands out further; hence the margin. It is 1.3% of the reach where two rims
/// cut out a pointed oval, and 1.8% where a stop is a pentagon.
template <class Bundle>
EntryRectangle lit_rectangle(const Bundle& bundle, const RayLoop& loop = {}) {
    constexpr int kSpokes = 128;
    constexpr double kMargin = 1.03;
    Vec2<double> low = {bundle.middle.x - bundle.reach.x, bundle.middle.y - bundle.reach.y};
    Vec2<double> high = {bundle.middle.x + bundle.reach.x, bundle.middle.y + bundle.reach.y};
    for (const LitSpoke& spoke : lit_spokes(bundle, kSpokes, loop))
        for (const Stretch& stretch : spoke.stretches) {
            const Vec2<double> edge = spoke.at(bundle, kMargin * stretch.to);
            low = {std::min(low.x, edge.x), std::min(low.y, edge.y)};
            high = {std::max(high.x, edge.x), std::max(high.y, edge.y)};
        }
    if (bundle.mirrored) low.x = -high.x;
    return {{0.5 * (low.x + high.x), 0.5 * (low.y + high.y)}, {0.5 * (high.x - low.x), 0.5 * (high.y - low.y)}};
}

/// Rays for integrals over what passes the lens: on each spoke Gauss's nodes between the edges of the light, wherever
/// rims, blades and obstructions put them. So nothing is lost at edges, and smooth functions need few rays. Rays of a
/// half bundle stand for twice their area.
template <class Bundle>
std::vector<EntryPart> entry_parts(const Bundle& bundle, const std::vector<LitSpoke>& spokes, int nodes) {
    std::vector<GaussNode> rule;
    for (int i = 0; i < nodes; ++i) rule.push_back(gauss_node(nodes, i));
    const double circle = bundle.reach.x * bundle.reach.y * 2 * std::numbers::pi;
    const double area = circle / static_cast<double>(spokes.size());
    std::vector<EntryPart> parts;
    for (const LitSpoke& spoke : spokes)
        for (const Stretch& stretch : spoke.stretches)
            for (const GaussNode& node : rule) {
                const double span = stretch.to - stretch.from, r = stretch.from + span * node.node;
                parts.push_back({spoke.at(bundle, r), area * r * span * node.weight});
            }
    return parts;
}

template <class Bundle>
std::vector<EntryPart> entry_parts(const Bundle& bundle, BundleSampling sampling, const RayLoop& loop = {}) {
    return entry_parts(bundle, lit_spokes(bundle, sampling.spokes, loop), sampling.nodes);
}

}  // namespace REALCAM_NAMESPACE
