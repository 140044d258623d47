#pragma once
#include <cmath>
#include <numbers>
#include <vector>

#include "../math/gauss_legendre.hpp"
#include "iris_shape.hpp"
#include "lens_system.hpp"
#include "ray_loop.hpp"

namespace REALCAM_NAMESPACE {

/// A place on the aperture stop, as a share of the radius of the circle that holds its opening.
struct PupilPoint {
    double x, y;
    double weight;  ///< share of the stop's area for which it stands, up to a common factor
    int cell = -1;  ///< of a square grid: its number, row by row from the lowest y
};

// Points of the stop, for integrals over it. Each throws what `loop` throws to stop it.

/// Midpoints of the cells of an n x n grid over the circle, those outside of it left out.
inline std::vector<PupilPoint> square_grid(int n, const RayLoop& loop = {}) {
    std::vector<PupilPoint> points;
    for (int row = 0; row < n; ++row) {
        loop.heed();
        for (int column = 0; column < n; ++column) {
            const double x = (2 * column + 1.0) / n - 1, y = (2 * row + 1.0) / n - 1;
            if (x * x + y * y <= 1) points.push_back({x, y, 1, row * n + column});
        }
    }
    return points;
}

/// A middle point and n rings of 6, 12, 18 ... points at equal distances, all of one weight: as OpticStudio's standard
/// spot diagram. The outermost ring lies on the edge.
inline std::vector<PupilPoint> hexapolar(int n, const RayLoop& loop = {}) {
    std::vector<PupilPoint> points{{0, 0, 1}};
    points.reserve(1 + 3 * static_cast<std::size_t>(n) * static_cast<std::size_t>(n + 1));
    for (int ring = 1; ring <= n; ++ring) {
        loop.heed();
        for (int i = 0; i < 6 * ring; ++i) {
            const double radius = static_cast<double>(ring) / n, angle = 2 * std::numbers::pi * i / (6 * ring);
            points.push_back({radius * std::cos(angle), radius * std::sin(angle), 1});
        }
    }
    return points;
}

/// n rings at the nodes of Gauss and Legendre in the squared radius, 4 n points each: integrals over a full round
/// pupil are exact for polynomials up to degree 4 n - 2 (G. W. Forbes, "Optical system assessment for design:
/// numerical ray tracing in the Gaussian pupil", J. Opt. Soc. Am. A 5, 1943, 1988).
inline std::vector<PupilPoint> gauss_rings(int n, const RayLoop& loop = {}) {
    std::vector<PupilPoint> points;
    points.reserve(4 * static_cast<std::size_t>(n) * static_cast<std::size_t>(n));
    for (int ring = 0; ring < n; ++ring) {
        loop.heed();
        const GaussNode rule = gauss_node(n, ring);
        const double weight = rule.weight / (4 * n), radius = std::sqrt(rule.node);
        for (int i = 0; i < 4 * n; ++i) {
            const double angle = 2 * std::numbers::pi * (i + 0.5) / (4 * n);
            points.push_back({radius * std::cos(angle), radius * std::sin(angle), weight});
        }
    }
    return points;
}

/// Radius of the smallest circle that holds the opening of the stop, mm: places on the stop are shares of it.
inline double stop_reach(const LensSystem& lens) {
    const double rim = lens.stop().clear_semi_diameter;
    if (lens.iris.blades == 0 || lens.is_wide_open()) return std::min(lens.stop_semi_diameter, rim);
    const Iris<double> iris = open_iris(lens.iris, lens.stop_semi_diameter, rim);
    return std::min(rim, opening_radius(iris.apothem, iris.curvature, std::cos(std::numbers::pi / iris.blades)));
}

}  // namespace REALCAM_NAMESPACE
