#include "open_iris.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace realcam {

double opening_radius(double apothem, double curvature, double cosine) {
    const double linear = (1 - curvature * apothem) * cosine;
    const double constant = 2 * apothem - curvature * apothem * apothem;
    return constant / (linear + std::sqrt(linear * linear + curvature * constant));
}

double iris_area(const IrisShape& shape, double apothem, double rim) {
    // The opening consists of 2n congruent parts. One is integrated in polar coordinates by the midpoint rule. Its
    // error for this smooth function (one kink at the rim) is below 1e-6 of the area at 2048 points.
    constexpr int kPoints = 2048;
    const double q = shape.rounding / apothem;
    const double width = std::numbers::pi / shape.blades;
    double sum = 0;
    for (int i = 0; i < kPoints; ++i) {
        const double cosine = std::cos((i + 0.5) * width / kPoints);
        sum += std::pow(std::min(opening_radius(apothem, q, cosine), rim), 2);
    }
    return shape.blades * width * sum / kPoints;
}

Iris<double> open_iris(const IrisShape& shape, double circle_radius, double rim) {
    const double wanted = std::numbers::pi * circle_radius * circle_radius;
    // The area grows with the apothem; the opening contains the circle whose radius is the apothem, and lies inside one
    // of twice that radius.
    double low = 0.5 * circle_radius, high = circle_radius > 0 && circle_radius < rim ? circle_radius : 2 * rim;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (iris_area(shape, middle, rim) < wanted ? low : high) = middle;
    }
    Iris<double> iris{};
    iris.blades = shape.blades;
    iris.apothem = high;
    iris.curvature = shape.rounding / high;
    for (int b = 0; b < shape.blades; ++b) {
        const double angle = shape.rotation_rad + 2 * std::numbers::pi * b / shape.blades;
        iris.cos[b] = std::cos(angle);
        iris.sin[b] = std::sin(angle);
    }
    return iris;
}

}  // namespace realcam
