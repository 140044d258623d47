#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "../../math/gauss_legendre.hpp"
#include "../../math/vec3.hpp"
#include "../trace/ray_loop.hpp"

// Numerical integration over ray bundles, and search for their edges. A bundle is all light of one object point or film
// point, parametrised by the entry points of its rays: coordinates in which the density of the light is uniform. The
// type `Bundle` must have
//   Vec2<double> middle, reach;  // approximate bounds of the entry points that pass: centre and half-sides
//   bool mirrored;               // true if the bundle is symmetric under x -> -x; then only its half x > 0 is sampled
//   template <int N> void pass(const Vec2<double> (&entries)[N], bool (&passed)[N]) const;  // traces N rays
// as FilmBundle, PointBundle, and SceneBundle do.

namespace REALCAM_NAMESPACE {

/// Resolution of an integral over a ray bundle.
struct BundleSampling {
    int arms;  ///< radial scan lines from the centre of the bundle, over the full circle
    int nodes;  ///< Gauss nodes on each interval of a scan line that passes
};

/// A ray of an integral over a bundle.
struct QuadratureRay {
    Vec2<double> entry;  ///< entry point of the ray
    double area;  ///< quadrature weight: area of entry points that the ray represents
};

/// Interval of a radial scan line in which light passes.
struct RadialInterval {
    double from, to;  ///< distances from the bundle's centre, in units of its half-sides
};

namespace bundle_quadrature_detail {

/// Search along a radial scan line, from the centre of a bundle outwards. Distances are in units of the bundle's
/// half-sides.
template <class Bundle>
class ScanLine {
public:
    ScanLine(const Bundle& bundle, double angle) : bundle_(bundle), cos_(std::cos(angle)), sin_(std::sin(angle)) {}

    /// Entry point at distance r.
    Vec2<double> at(double r) const {
        return {bundle_.middle.x + r * cos_ * bundle_.reach.x, bundle_.middle.y + r * sin_ * bundle_.reach.y};
    }

    /// Returns the intervals in which light passes, outwards. The line is sampled in steps of kStep, so that narrower
    /// intervals may be missed. Edges are accurate to kEdgeTolerance.
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
    static constexpr double kStep = 1.0 / 20;  // between samples of the line
    static constexpr int kSteps = 35;  // up to a distance of 1.7, past the corners of the bounding rectangle
    static constexpr double kEdgeTolerance = 1e-9;

    /// Finds the edge between `low` and `high`, where light passes at exactly one of the two, by repeated division into
    /// quarters. `beyond`: true if light passes at `high`.
    double edge(double low, double high, bool beyond) const {
        while (high - low > kEdgeTolerance) {
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

/// A radial scan line (arm) of the polar quadrature.
struct QuadratureArm {
    double cos, sin;  ///< direction of the line, in units of the half-sides
    std::vector<RadialInterval> intervals;  ///< in which light passes, outwards

    /// Entry point at distance r.
    template <class Bundle>
    Vec2<double> at(const Bundle& bundle, double r) const {
        return {bundle.middle.x + r * cos * bundle.reach.x, bundle.middle.y + r * sin * bundle.reach.y};
    }
};

/// Returns scan lines at equally spaced angles, in ascending order from -90 degrees. `count`: their number over the
/// full circle, rounded up to an even number. For a mirrored bundle only the half with x > 0 is returned. Throws
/// Cancelled if `loop` is cancelled.
template <class Bundle>
std::vector<QuadratureArm> quadrature_arms(const Bundle& bundle, int count, const RayLoop& loop = {}) {
    using namespace bundle_quadrature_detail;
    const std::size_t half_count = static_cast<std::size_t>(count + 1) / 2,
                      arms = bundle.mirrored ? half_count : 2 * half_count;
    const double spacing = std::numbers::pi / static_cast<double>(half_count);
    std::vector<QuadratureArm> arms_found(arms);
    loop.for_all(arms, [&](std::size_t first, std::size_t last) {
        for (std::size_t s = first; s < last; ++s) {
            const double angle = spacing * (static_cast<double>(s) + 0.5) - 0.5 * std::numbers::pi;
            arms_found[s] = {std::cos(angle), std::sin(angle), ScanLine(bundle, angle).intervals()};
        }
    });
    return arms_found;
}

/// Rectangle of entry points of a bundle.
struct EntryRectangle {
    Vec2<double> middle, reach;  ///< centre and half-sides
};

/// Returns a rectangle that contains all entry points that pass: the bundle's own rectangle, extended to the edges
/// found on 128 scan lines, with a margin. The margin covers corners of the light between two scan lines. They protrude
/// by 1.3% of the half-side if two rims form a pointed oval, and by 1.8% for a pentagonal stop.
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

/// Returns the rays of a quadrature over the light that passes the lens: `nodes` Gauss-Legendre nodes on each interval
/// of each scan line. Because the intervals end at the edges of the light, edges cause no error, and smooth functions
/// need few rays. In a mirrored bundle each ray has twice its area, to represent its mirror image, too.
template <class Bundle>
std::vector<QuadratureRay> quadrature_rays(const Bundle& bundle, const std::vector<QuadratureArm>& arms, int nodes) {
    std::vector<GaussNode> rule;
    for (int i = 0; i < nodes; ++i) rule.push_back(gauss_node(nodes, i));
    const double full_turn = bundle.reach.x * bundle.reach.y * 2 * std::numbers::pi;
    const double area = full_turn / static_cast<double>(arms.size());
    std::vector<QuadratureRay> parts;
    for (const QuadratureArm& arm : arms)
        for (const RadialInterval& interval : arm.intervals)
            for (const GaussNode& node : rule) {
                const double span = interval.to - interval.from, r = interval.from + span * node.node;
                parts.push_back({arm.at(bundle, r), area * r * span * node.weight});
            }
    return parts;
}

/// Same for scan lines that are searched first.
template <class Bundle>
std::vector<QuadratureRay> quadrature_rays(const Bundle& bundle, BundleSampling sampling, const RayLoop& loop = {}) {
    return quadrature_rays(bundle, quadrature_arms(bundle, sampling.arms, loop), sampling.nodes);
}

}  // namespace REALCAM_NAMESPACE
