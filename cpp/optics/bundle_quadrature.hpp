#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "../math/gauss_legendre.hpp"
#include "../math/vec3.hpp"
#include "ray_loop.hpp"

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

namespace bundle_quadrature_detail {

struct Stretch {
    double from, to;
};

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

/// Rays for integrals over what passes the lens, of a PointBundle or a FilmBundle: on each spoke Gauss's nodes between
/// the edges of the light, wherever rims, blades and obstructions put them. So nothing is lost at edges, and smooth
/// functions need few rays. Of a bundle that is its own mirror image only the half of x > 0 is taken, with twice the
/// area.
template <class Bundle>
std::vector<EntryPart> entry_parts(const Bundle& bundle, BundleSampling sampling, const RayLoop& loop = {}) {
    using namespace bundle_quadrature_detail;
    std::vector<GaussNode> rule;
    for (int i = 0; i < sampling.nodes; ++i) rule.push_back(gauss_node(sampling.nodes, i));
    const std::size_t half = static_cast<std::size_t>(sampling.spokes + 1) / 2,
                      spokes = bundle.mirrored ? half : 2 * half;
    const double between = std::numbers::pi / static_cast<double>(half);
    const double area = bundle.reach.x * bundle.reach.y * between * (bundle.mirrored ? 2 : 1);
    std::vector<std::vector<EntryPart>> of_spoke(spokes);
    loop.for_all(spokes, [&](std::size_t first, std::size_t last) {
        for (std::size_t s = first; s < last; ++s) {
            const Spoke spoke(bundle, between * (static_cast<double>(s) + 0.5) - 0.5 * std::numbers::pi);
            for (const Stretch& stretch : spoke.stretches())
                for (const GaussNode& node : rule) {
                    const double span = stretch.to - stretch.from, r = stretch.from + span * node.node;
                    of_spoke[s].push_back({spoke.at(r), area * r * span * node.weight});
                }
        }
    });
    std::vector<EntryPart> parts;
    for (const std::vector<EntryPart>& more : of_spoke) parts.insert(parts.end(), more.begin(), more.end());
    return parts;
}

}  // namespace REALCAM_NAMESPACE
