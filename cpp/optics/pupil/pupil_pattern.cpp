#include "pupil_pattern.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../../math/gauss_legendre.hpp"
#include "../trace/open_iris.hpp"

namespace realcam {

std::vector<PupilPoint> square_grid(int n, const RayLoop& loop) {
    std::vector<PupilPoint> points;
    for (int row = 0; row < n; ++row) {
        loop.throw_if_cancelled();
        for (int column = 0; column < n; ++column) {
            const double x = (2 * column + 1.0) / n - 1, y = (2 * row + 1.0) / n - 1;
            if (x * x + y * y <= 1) points.push_back({x, y, 1, row * n + column});
        }
    }
    return points;
}

std::vector<PupilPoint> hexapolar(int n, const RayLoop& loop) {
    std::vector<PupilPoint> points{{0, 0, 1}};
    points.reserve(1 + 3 * static_cast<std::size_t>(n) * static_cast<std::size_t>(n + 1));
    for (int ring = 1; ring <= n; ++ring) {
        loop.throw_if_cancelled();
        for (int i = 0; i < 6 * ring; ++i) {
            const double radius = static_cast<double>(ring) / n, angle = 2 * std::numbers::pi * i / (6 * ring);
            points.push_back({radius * std::cos(angle), radius * std::sin(angle), 1});
        }
    }
    return points;
}

std::vector<PupilPoint> gauss_rings(int n, const RayLoop& loop) {
    std::vector<PupilPoint> points;
    points.reserve(4 * static_cast<std::size_t>(n) * static_cast<std::size_t>(n));
    for (int ring = 0; ring < n; ++ring) {
        loop.throw_if_cancelled();
        const GaussNode rule = gauss_node(n, ring);
        const double weight = rule.weight / (4 * n), radius = std::sqrt(rule.node);
        for (int i = 0; i < 4 * n; ++i) {
            const double angle = 2 * std::numbers::pi * (i + 0.5) / (4 * n);
            points.push_back({radius * std::cos(angle), radius * std::sin(angle), weight});
        }
    }
    return points;
}

double stop_bounding_radius(const LensSystem& lens) {
    if (lens.iris.blades == 0 || lens.is_wide_open()) return lens.open_stop_radius();
    const double rim = lens.stop().clear_semi_diameter;
    const Iris<double> iris = open_iris(lens.iris, lens.stop_semi_diameter, rim);
    return std::min(rim, opening_radius(iris.apothem, iris.curvature, std::cos(std::numbers::pi / iris.blades)));
}

}  // namespace realcam
