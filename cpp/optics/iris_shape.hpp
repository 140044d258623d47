#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "lens_view.hpp"

namespace REALCAM_NAMESPACE {

/// The blades of a diaphragm, whatever its opening. blades = 0: a round diaphragm.
struct IrisShape {
    int blades = 0;
    double rounding = 0;      ///< 0: straight edges; 1: the opening is a circle
    double rotation_rad = 0;  ///< of the first blade, from the x axis towards y

    bool operator==(const IrisShape&) const = default;
};

/// Distance from the axis to a blade's edge in the direction that makes an angle of this cosine with the blade's
/// middle, mm: of q r^2 + 2 (1 - q h) cos r - (2 h - q h^2) = 0, in the form that holds for q = 0 too.
inline double opening_radius(double apothem, double curvature, double cosine) {
    const double linear = (1 - curvature * apothem) * cosine;
    const double constant = 2 * apothem - curvature * apothem * apothem;
    return constant / (linear + std::sqrt(linear * linear + curvature * constant));
}

/// Area that n blades at a distance `apothem` from the axis leave open inside a round rim, mm^2.
inline double iris_area(const IrisShape& shape, double apothem, double rim) {
    // The opening has 2n equal parts; one is integrated in polar form by the midpoint rule, whose error for this
    // smooth function (one kink at the rim) is below 1e-6 of the area at 2048 points.
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

/// The opening that has the area of a circle of the given radius inside the stop's fixed rim: f-numbers then mean
/// the same light with and without blades. Wide open the blades are behind the rim.
inline Iris<double> open_iris(const IrisShape& shape, double circle_radius, double rim) {
    const double wanted = std::numbers::pi * circle_radius * circle_radius;
    // The area grows with the apothem; the opening holds the circle of its apothem, and lies in one of twice it.
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

}  // namespace REALCAM_NAMESPACE
