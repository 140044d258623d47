#include "surface.hpp"

#include <cmath>
#include <cstddef>

namespace realcam {

std::string Surface::asymmetry() const {
    if (placement.tilt_deg != Vec3d{0, 0, 0}) return "is tilted";
    if (placement.decentre != Vec3d{0, 0, 0}) return "is decentred";
    return "";
}

double Surface::sag(double radius) const {
    const double r2 = radius * radius;
    double polynomial = 0;
    for (std::size_t i = aspheric.size(); i-- > 0;) polynomial = polynomial * r2 + aspheric[i];
    const double root = std::sqrt(1 - (1 + conic) * curvature * curvature * r2);
    return curvature * r2 / (1 + root) + r2 * r2 * polynomial;
}

}  // namespace realcam
