#pragma once
#include <cmath>
#include <numbers>

#include "affine.hpp"

namespace REALCAM_NAMESPACE {

/// Returns the rotation about x, then y, then z, by angles in degrees.
inline Affine<double> turn_of(Vec3d degrees) {
    const auto turn = [](double angle_deg, Vec3d Affine<double>::* a, Vec3d Affine<double>::* b) {
        const double angle = angle_deg * (std::numbers::pi / 180);
        Affine<double> map;
        const Vec3d u = map.*a, v = map.*b;
        map.*a = std::cos(angle) * u + std::sin(angle) * v;
        map.*b = std::cos(angle) * v - std::sin(angle) * u;
        return map;
    };
    using A = Affine<double>;
    return turn(degrees.z, &A::x, &A::y) * turn(degrees.y, &A::z, &A::x) * turn(degrees.x, &A::y, &A::z);
}

}  // namespace REALCAM_NAMESPACE
