#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "../../math/gauss_legendre.hpp"
#include "../../math/vec3.hpp"
#include "../trace/ray_loop.hpp"

namespace REALCAM_NAMESPACE {

/// Resolution of an integral over a ray bundle: number of radial arms about its centre, and of Gauss nodes
/// on each lit interval.
struct BundleSampling {
    int arms, nodes;
};

/// A ray of an integral over a bundle. Its entry is a point in the coordinates in which the bundle's density is
/// uniform.
struct EntryPart {
    Vec2<double> entry;
    double area;  ///< quadrature weight, in the squared unit of the entry
};

/// A lit interval of an arm: distances from the bundle's centre in units of its half-sides `reach`.
struct RadialInterval {
    double from, to;
};

namespace bundle_quadrature_detail {

/// A radial scan line from the centre of a bundle outwards, with distances in units of the bundle's half-sides.
template <class Bundle>
class ScanLine {
public:
    ScanLine(const Bundle& bundle, double angle) : bundle_(bundle), cos_(std::cos(angle)), sin_(std::sin(angle)) {}

    Vec2<double> at(double r) const {
        return {bundle_.middle.x + r * cos_ * bundle_.reach.x, bundle_.middle.y + r * sin_ * bundle_.reach.y};
    }

    /// Returns the lit intervals. Samples in steps of a twentieth of the half-side, so that narrower intervals may be
    /// missed; edges are found within 1e-9 of it.
    std::vector<RadialInterval> intervals() const {
        Vec2<double> entries[kSteps];
        bool passes[kSteps];
        for (int i = 0; i < kSteps; ++i) entries[i] = at(i * kStep);
        bundle_.pass(entries, passes);
        std::vector<RadialInterval> found;
        if (passes[0]) found.push_back({0, 0});
        for (int i = 1; i < kSteps; ++i) {
            if (passes[i] == passes[i - 1]) continue;
            const double radius = edge((i - 1) * kStep, i * kStep, passes[i]);
            if (passes[i])
                found.push_back({radius, radius});
            else
                found.back().to = radius;
        }
        if (passes[kSteps - 1]) found.back().to = (kSteps - 1) * kStep;
        return found;
    }

private:
    static constexpr int kSteps = 35;
    static constexpr double kStep = 1.0 / 20;  // up to 1.7: past the corners of the rectangle

    /// Finds the edge by division into quarters, between a point like the previous sample and one like the next
    /// (`beyond`).
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

/// An arm of the polar quadrature with its lit intervals.
struct QuadratureArm {
    double cos, sin;
    std::vector<RadialInterval> intervals;

    template <class Bundle>
    Vec2<double> at(const Bundle& bundle, double r) const {
        return {bundle.middle.x + r * cos * bundle.reach.x, bundle.middle.y + r * sin * bundle.reach.y};
    }
};

/// Returns arms at equally spaced angles, in the order of their angles from -90 degrees on. For a bundle that is its
/// own mirror image, only the half of x > 0 is returned; `count` is that of the whole bundle.
template <class Bundle>
std::vector<QuadratureArm> quadrature_arms(const Bundle& bundle, int count, const RayLoop& loop = {}) {
    using namespace bundle_quadrature_detail;
    const std::size_t half = static_cast<std::size_t>(count + 1) / 2, arms = bundle.mirrored ? half : 2 * half;
    const double between = std::numbers::pi / static_cast<double>(half);
    std::vector<QuadratureArm> lit(arms);
    loop.for_all(arms, [&](std::size_t first, std::size_t last) {
        for (std::size_t s = first; s < last; ++s) {
            const double angle = between * (static_cast<double>(s) + 0.5) - 0.5 * std::numbers::pi;
            lit[s] = {std::cos(angle), std::sin(angle), ScanLine(bundle, angle).intervals()};
        }
    });
    return lit;
}

/// A rectangle in the entry coordinates of a bundle.
struct EntryRectangle {
    Vec2<double> middle, reach;  ///< `reach`: half-sides
};

/// Returns a rectangle that contains all light of a bundle: the bundle's own, extended to the edges found on arms.
/// Between two of 128 arms a corner of the light protrudes further; hence the margin. The protrusion is 1.3% of the
/// half-side where two rims cut out a pointed oval, and 1.8% for a pentagonal stop.
template <class Bundle>
EntryRectangle lit_rectangle(const Bundle& bundle, const RayLoop& loop = {}) {
    constexpr int kArms = 128;
    constexpr double kMargin = 1.03;
    Vec2<double> low = {bundle.middle.x - bundle.reach.x, bundle.middle.y - bundle.reach.y};
    Vec2<double> high = {bundle.middle.x + bundle.reach.x, bundle.middle.y + bundle.reach.y};
    for (const QuadratureArm& arm : quadrature_arms(bundle, kArms, loop))
        for (const RadialInterval& interval : arm.intervals) {
            const Vec2<double> edge = arm.at(bundle, kMargin * interval.to);
            low = {std::min(low.x, edge.x), std::min(low.y, edge.y)};
            high = {std::max(high.x, edge.x), std::max(high.y, edge.y)};
        }
    if (bundle.mirrored) low.x = -high.x;
    return {{0.5 * (low.x + high.x), 0.5 * (low.y + high.y)}, {0.5 * (high.x - low.x), 0.5 * (high.y - low.y)}};
}

/// Returns quadrature rays for integrals over the light that passes the lens: Gauss nodes on each lit interval of each
/// arm, wherever rims, blades and obstructions put its edges. So edges cause no error, and smooth functions need few
/// rays. In a half bundle each ray has twice its area, to stand for its mirror image.
template <class Bundle>
std::vector<EntryPart> entry_parts(const Bundle& bundle, const std::vector<QuadratureArm>& arms, int nodes) {
    std::vector<GaussNode> rule;
    for (int i = 0; i < nodes; ++i) rule.push_back(gauss_node(nodes, i));
    const double circle = bundle.reach.x * bundle.reach.y * 2 * std::numbers::pi;
    const double area = circle / static_cast<double>(arms.size());
    std::vector<EntryPart> parts;
    for (const QuadratureArm& arm : arms)
        for (const RadialInterval& interval : arm.intervals)
            for (const GaussNode& node : rule) {
                const double span = interval.to - interval.from, r = interval.from + span * node.node;
                parts.push_back({arm.at(bundle, r), area * r * span * node.weight});
            }
    return parts;
}

template <class Bundle>
std::vector<EntryPart> entry_parts(const Bundle& bundle, BundleSampling sampling, const RayLoop& loop = {}) {
    return entry_parts(bundle, quadrature_arms(bundle, sampling.arms, loop), sampling.nodes);
}

}  // namespace REALCAM_NAMESPACE
