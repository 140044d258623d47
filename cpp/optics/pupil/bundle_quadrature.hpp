#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "../../math/gauss_legendre.hpp"
#include "../../math/vec3.hpp"
#include "../trace/ray_loop.hpp"

namespace REALCAM_NAMESPACE {

/// Resolution of an integral over a ray bundle: number of radial scan lines (spokes) about its centre, and of Gauss
/// nodes on each lit interval.
struct BundleSampling {
    int spokes, nodes;
};

/// A ray of an integral over a bundle. Its entry is a point in the coordinates in which the bundle's density is
/// uniform.
struct EntryPart {
    Vec2<double> entry;
    double area;  ///< quadrature weight, in the squared unit of the entry
};

/// A lit interval of a spoke: distances from the bundle's centre in units of its half-sides `reach`.
struct Stretch {
    double from, to;
};

namespace bundle_quadrature_detail {

/// A radial scan line from the centre of a bundle outwards, with distances in units of the bundle's half-sides.
template <class Bundle>
class Spoke {
public:
    Spoke(const Bundle& bundle, double angle) : bundle_(bundle), cos_(std::cos(angle)), sin_(std::sin(angle)) {}

    Vec2<double> at(double r) const {
        return {bundle_.middle.x + r * cos_ * bundle_.reach.x, bundle_.middle.y + r * sin_ * bundle_.reach.y};
    }

    /// Returns the lit intervals. Samples in steps of a twentieth of the half-side, so that narrower intervals may be
    /// missed; edges are found within 1e-9 of it.
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

/// A spoke with its lit intervals.
struct LitSpoke {
    double cos, sin;
    std::vector<Stretch> stretches;

    template <class Bundle>
    Vec2<double> at(const Bundle& bundle, double r) const {
        return {bundle.middle.x + r * cos * bundle.reach.x, bundle.middle.y + r * sin * bundle.reach.y};
    }
};

/// Returns spokes at equally spaced angles, in the order of their angles from -90 degrees on. For a bundle that is its
/// own mirror image, only the half of x > 0 is returned; `count` is that of the whole bundle.
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

/// A rectangle in the entry coordinates of a bundle.
struct EntryRectangle {
    Vec2<double> middle, reach;  ///< `reach`: half-sides
};

/// Returns a rectangle that contains all light of a bundle: the bundle's own, extended to the edges found on spokes.
/// Between two of 128 spokes a corner of the light protrudes further; hence the margin. The protrusion is 1.3% of the
/// half-side where two rims cut out a pointed oval, and 1.8% for a pentagonal stop.
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

/// Returns quadrature rays for integrals over the light that passes the lens: Gauss nodes on each lit interval of each
/// spoke, wherever rims, blades and obstructions put its edges. So edges cause no error, and smooth functions need few
/// rays. In a half bundle each ray has twice its area, to stand for its mirror image.
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
