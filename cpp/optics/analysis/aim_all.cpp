#include "aim_all.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "../../math/least_squares.hpp"

namespace realcam {

namespace {

/// Fits a map from stop to entry plane to rays aimed one by one at Gauss's nodes, which distinguish polynomials of up
/// to twice the degree. Returns std::nullopt if some points of the stop cannot be reached, so that the map cannot be
/// extrapolated to them.
std::optional<StopMap> stop_map(const RayAimer& aim, double reach, const RayLoop& loop) {
    const std::vector<PupilPoint> nodes = gauss_rings(8);
    std::vector<AimedRay> rays;
    loop.append_all(rays, nodes.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) rays[i] = aim({reach * nodes[i].x, reach * nodes[i].y});
    });
    std::vector<std::vector<double>> powers(StopMap::kTerms), entries(2);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!std::isfinite(rays[i].entry.x + rays[i].entry.y)) return {};
        entries[0].push_back(rays[i].entry.x);
        entries[1].push_back(rays[i].entry.y);
        std::size_t term = 0;
        double x_power = 1;
        for (int a = 0; a <= StopMap::kDegree; ++a, x_power *= nodes[i].x) {
            double product = x_power;
            for (int b = 0; a + b <= StopMap::kDegree; ++b, product *= nodes[i].y) powers[term++].push_back(product);
        }
    }
    const auto factors = least_squares(powers, std::move(entries));
    StopMap map{};
    map.reach = reach;
    std::copy(factors[0].begin(), factors[0].end(), map.x);
    std::copy(factors[1].begin(), factors[1].end(), map.y);
    return map;
}

}  // namespace

std::vector<AimedRay> aim_all(const RayAimer& aim, const std::vector<PupilPoint>& pattern, double reach,
                              const RayLoop& loop) {
    constexpr std::size_t kMany = 1000;  // fitting the map takes as long as aiming some 500 rays
    std::vector<AimedRay> rays;
    const std::optional<StopMap> map = pattern.size() < kMany ? std::nullopt : stop_map(aim, reach, loop);
    loop.append_all(rays, pattern.size(), [&](std::size_t first, std::size_t last) {
        const auto target = [&](std::size_t i) { return Vec2<double>{reach * pattern[i].x, reach * pattern[i].y}; };
        if (map) {
            std::vector<Vec2<double>> targets;
            targets.reserve(last - first);
            for (std::size_t i = first; i < last; ++i) targets.push_back(aim.off_the_edge(target(i)));
            AimRequest request = aim.request(*map);
            request.count = static_cast<std::int64_t>(targets.size());
            request.targets = targets.data();
            request.rays = rays.data() + first;
            loop.aim_rays ? loop.aim_rays(request) : aim_rays<16>(request);
        }
        for (std::size_t i = first; i < last; ++i)
            if (!map || !std::isfinite(rays[i].entry.x)) rays[i] = aim(target(i));
    });
    return rays;
}

}  // namespace realcam
