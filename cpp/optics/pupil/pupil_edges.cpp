#include "pupil_edges.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace realcam {

PupilEdgeSearch::PupilEdgeSearch(const LensSystem& lens, const PupilTracer& tracer)
    : path_(lens, LightDirection::to_scene, lens.wavelength_nm), film_distance_(lens.film_distance), tracer_(tracer) {}

std::optional<PupilEdges> PupilEdgeSearch::at(double radius, double azimuth, const DirectionBox& box) const {
    const Spokes spokes(radius, azimuth, box, film_distance_);
    // Outer edges in the first half of the block, inner ones in the second.
    std::array<double, 2 * kSpokes> lit{}, dark{};
    if (!scan(spokes, lit, dark)) return std::nullopt;
    for (int halving = 0; halving < kHalvings; ++halving) {
        std::array<double, 2 * kSpokes> middle;
        for (std::size_t i = 0; i < middle.size(); ++i) middle[i] = 0.5 * (lit[i] + dark[i]);
        const std::array<bool, 2 * kSpokes> passes = trace(spokes, middle);
        for (std::size_t i = 0; i < middle.size(); ++i) (passes[i] ? lit : dark)[i] = middle[i];
    }
    bool is_obstructed = true;
    for (int i = 0; i < kSpokes; ++i) is_obstructed &= lit[static_cast<std::size_t>(kSpokes + i)] > 0;
    PupilEdges edges(is_obstructed ? 2 : 1);
    for (int i = 0; i < kSpokes; ++i) {
        edges[0].push_back(spokes.direction(i, lit[static_cast<std::size_t>(i)]));
        const int back = 2 * kSpokes - 1 - i;
        if (is_obstructed) edges[1].push_back(spokes.direction(back, lit[static_cast<std::size_t>(back)]));
    }
    return edges;
}

PupilEdgeSearch::Spokes::Spokes(double radius, double azimuth, const DirectionBox& box, double film_distance)
    : box(box), cos(std::cos(azimuth)), sin(std::sin(azimuth)), film{radius * cos, radius * sin, film_distance} {}

Vec2<double> PupilEdgeSearch::Spokes::direction(int spoke, double reach) const {
    const double angle = 2 * std::numbers::pi * (spoke % kSpokes) / kSpokes;
    const double l = box.centre().l + reach * box.half_width() * std::cos(angle),
                 m = reach * box.half_height() * std::sin(angle);
    return {l * cos - m * sin, l * sin + m * cos};
}

std::array<bool, 2 * PupilEdgeSearch::kSpokes> PupilEdgeSearch::trace(
    const Spokes& spokes, const std::array<double, 2 * kSpokes>& reach) const {
    PupilTracer::Rays rays;
    const double index_squared = path_.entry_index * path_.entry_index;
    for (int i = 0; i < 2 * kSpokes; ++i) {
        const Vec2<double> d = spokes.direction(i, reach[static_cast<std::size_t>(i)]);
        const double rest = index_squared - d.x * d.x - d.y * d.y;
        rays.origin.set(i, static_cast<Vec3f>(spokes.film));
        rays.direction.set(i, static_cast<Vec3f>(Vec3d{d.x, d.y, -std::sqrt(std::max(rest, 0.0))}));
        rays.status[i] = rest > 0 ? 0 : static_cast<int>(RayStatus::vignetted);
    }
    tracer_.trace(path_.view(), rays);
    std::array<bool, 2 * kSpokes> passes;
    for (int i = 0; i < 2 * kSpokes; ++i) passes[static_cast<std::size_t>(i)] = rays.status[i] == 0;
    return passes;
}

bool PupilEdgeSearch::scan(const Spokes& spokes, std::array<double, 2 * kSpokes>& lit,
                           std::array<double, 2 * kSpokes>& dark) const {
    std::array<int, kSpokes> first, last;
    first.fill(-1);
    last.fill(-1);
    for (int step = 0; step < kSteps; step += 2) {
        std::array<double, 2 * kSpokes> reach;
        for (std::size_t i = 0; i < reach.size(); ++i) reach[i] = reach_at(step + (i < kSpokes ? 0 : 1));
        const std::array<bool, 2 * kSpokes> passes = trace(spokes, reach);
        for (int half = 0; half < 2; ++half)
            for (std::size_t i = 0; i < kSpokes; ++i) {
                if (!passes[static_cast<std::size_t>(half) * kSpokes + i]) continue;
                if (first[i] < 0) first[i] = step + half;
                last[i] = step + half;
            }
    }
    for (std::size_t i = 0; i < kSpokes; ++i) {
        if (first[i] < 0) return false;
        lit[i] = reach_at(last[i]);
        dark[i] = reach_at(last[i] + 1);
        lit[kSpokes + i] = reach_at(first[i]);
        dark[kSpokes + i] = reach_at(std::max(first[i] - 1, 0));
    }
    return true;
}

}  // namespace realcam
