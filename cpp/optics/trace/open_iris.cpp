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
    const double curvature = shape.rounding / apothem;
    const double half_sector = std::numbers::pi / shape.blades;
    double sum = 0;
    for (int i = 0; i < kPoints; ++i) {
        const double cosine = std::cos((i + 0.5) * half_sector / kPoints);
        sum += std::pow(std::min(opening_radius(apothem, curvature, cosine), rim), 2);
    }
    return shape.blades * half_sector * sum / kPoints;
}

Iris<double> open_iris(const IrisShape& shape, double circle_radius, double rim) {
    const double area = std::numbers::pi * circle_radius * circle_radius;
    // The area grows with the apothem; the opening contains the circle whose radius is the apothem, and lies inside one
    // of twice that radius.
    double low = 0.5 * circle_radius, high = circle_radius > 0 && circle_radius < rim ? circle_radius : 2 * rim;
    constexpr int kHalvings = 60;  // to the last digit of a double
    for (int i = 0; i < kHalvings; ++i) {
        const double middle = 0.5 * (low + high);
        (iris_area(shape, middle, rim) < area ? low : high) = middle;
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
