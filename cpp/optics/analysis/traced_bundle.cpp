#include "traced_bundle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "plane_waves.hpp"

namespace realcam {

namespace {

constexpr int kEdgeParts = 8;

/// A point on the edge of the light: its entry and its slope.
struct EdgePoint {
    PointBundle::Entry entry;
    Vec2<double> slope;
};

EdgePoint edge_point(const PointBundle& bundle, const QuadratureArm& arm, double r) {
    const PointBundle::Entry entries[1] = {arm.at(bundle, r)};
    FilmRay found[1];
    bundle.trace(entries, found);
    return {entries[0], bundle.as_wave(found[0]).slope};
}

EdgePoint mirrored(const EdgePoint& p) {
    return {{-p.entry.x, p.entry.y}, {-p.slope.x, p.slope.y}};
}

/// Interpolates between the middle two of four equally spaced points, by the cubic through them.
EdgePoint between(const std::array<EdgePoint, 4>& p, double share) {
    const double t = share, weight[4] = {-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2,
                                         -(t + 1) * t * (t - 2) / 2, (t + 1) * t * (t - 1) / 6};
    EdgePoint point{{0, 0}, {0, 0}};
    for (int k = 0; k < 4; ++k) {
        const EdgePoint& from = p[static_cast<std::size_t>(k)];
        point.entry = {point.entry.x + weight[k] * from.entry.x, point.entry.y + weight[k] * from.entry.y};
        point.slope = {point.slope.x + weight[k] * from.slope.x, point.slope.y + weight[k] * from.slope.y};
    }
    return point;
}

/// Returns segments between the edges on neighbouring radial scan lines. They are subdivided if the edge continues to
/// either side: the area of a polygon of 32 straight segments would be 0.6% too small. An interval of light on only one
/// of the two lines is closed by a segment along that line.
std::vector<EdgePiece> edge_of(const PointBundle& bundle, const std::vector<QuadratureArm>& half) {
    // Inner and outer edge of each interval. If the light begins at the centre, the inner edges coincide there.
    using Edges = std::vector<std::array<EdgePoint, 2>>;
    std::vector<Edges> arms;
    for (const QuadratureArm& arm : half) {
        Edges edges;
        for (const RadialInterval& interval : arm.intervals)
            edges.push_back({edge_point(bundle, arm, interval.from), edge_point(bundle, arm, interval.to)});
        arms.push_back(std::move(edges));
    }
    if (bundle.mirrored)
        for (std::size_t s = half.size(); s-- > 0;) {
            Edges edges = arms[s];
            for (auto& edge : edges) edge = {mirrored(edge[0]), mirrored(edge[1])};
            arms.push_back(std::move(edges));
        }
    std::vector<EdgePiece> pieces;
    const auto add = [&](const EdgePoint& a, const EdgePoint& b) {
        if (a.entry.x != b.entry.x || a.entry.y != b.entry.y)
            pieces.push_back({{a.entry, b.entry}, {a.slope, b.slope}});
    };
    for (std::size_t s = 0; s < arms.size(); ++s) {
        const auto at = [&](std::size_t k) -> const Edges& { return arms[(s + k) % arms.size()]; };
        const Edges &before = at(arms.size() - 1), &here = at(0), &next = at(1), &beyond = at(2);
        const std::size_t both = std::min(here.size(), next.size());
        const std::size_t smooth = std::min({before.size(), both, beyond.size()});
        for (std::size_t i = 0; i < both; ++i)
            for (std::size_t side : {0, 1}) {
                const int parts = i < smooth ? kEdgeParts : 1;
                EdgePoint from = here[i][side];
                for (int k = 1; k <= parts; ++k) {
                    const EdgePoint to = k == parts
                                             ? next[i][side]
                                             : between({before[i][side], here[i][side], next[i][side], beyond[i][side]},
                                                       static_cast<double>(k) / parts);
                    add(from, to);
                    from = to;
                }
            }
        for (const Edges* longer : {&here, &next})
            for (std::size_t i = both; i < longer->size(); ++i) add((*longer)[i][0], (*longer)[i][1]);
    }
    return pieces;
}

/// Returns the distance behind the film plane at which two close rays on either side of the chief ray cross, mm. Their
/// offset is a thousandth of the bundle's reach: the error from aberrations falls off with its square, and rounding
/// stays below 1e-10 of the focus.
double close_focus(const PointBundle& bundle, bool tangential) {
    const double step = 1e-3 * std::max(bundle.reach.x, bundle.reach.y);
    const PointBundle::Entry chief = bundle.chief_entry;
    const PointBundle::Entry entries[2] = {{chief.x + (tangential ? 0 : step), chief.y + (tangential ? step : 0)},
                                           {chief.x - (tangential ? 0 : step), chief.y - (tangential ? step : 0)}};
    FilmRay rays[2];
    bundle.trace(entries, rays);
    if (!rays[0].passes || !rays[1].passes) return std::numeric_limits<double>::quiet_NaN();
    const auto height = [&](const FilmRay& ray) { return tangential ? ray.at.y : ray.at.x; };
    const auto rise = [&](const FilmRay& ray) {
        return (tangential ? ray.direction.y : ray.direction.x) / ray.direction.z;
    };
    return -(height(rays[0]) - height(rays[1])) / (rise(rays[0]) - rise(rays[1]));
}

}  // namespace

TracedBundle traced_bundle(const PointBundle& bundle, BundleSampling sampling, const RayLoop& loop) {
    const std::vector<QuadratureArm> arms = quadrature_arms(bundle, sampling.arms, loop);
    const std::vector<EntryPart> parts = entry_parts(bundle, arms, sampling.nodes);
    TracedBundle result{{}, edge_of(bundle, arms), close_focus(bundle, true), close_focus(bundle, false)};
    loop.append_all(result.rays, parts.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const PointBundle::Entry entries[1] = {parts[i].entry};
            FilmRay found[1];
            bundle.trace(entries, found);
            const std::optional<LocalWave> local = local_wave(bundle, parts[i].entry);
            const double density = bundle.energy(parts[i].entry);
            result.rays[i] = {parts[i].entry,
                              parts[i].area * density,
                              found[0].at,
                              found[0].direction,
                              bundle.as_wave(found[0]),
                              local ? std::sqrt(density / std::fabs(local->determinant())) : 0.0};
        }
    });
    double sum = 0;
    for (const BundleRay& ray : result.rays) sum += ray.energy;
    for (BundleRay& ray : result.rays) ray.energy *= (bundle.mirrored ? 0.5 : 1) / sum;
    if (!bundle.mirrored) return result;
    const std::size_t half = result.rays.size();
    for (std::size_t i = 0; i < half; ++i) {
        BundleRay ray = result.rays[i];
        ray.entry.x = -ray.entry.x;
        ray.at.x = -ray.at.x;
        ray.direction.x = -ray.direction.x;
        ray.wave.slope.x = -ray.wave.slope.x;
        result.rays.push_back(ray);
    }
    return result;
}

}  // namespace realcam
