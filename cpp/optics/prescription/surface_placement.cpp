#include "surface_placement.hpp"

#include <cmath>
#include <numbers>

#include "../../math/hypotenuse.hpp"

namespace realcam {

namespace {

constexpr double kDegree = std::numbers::pi / 180;

struct Turn {
    double cos, sin;
};

/// Cosine and sine, exact for right angles, which occur in fold mirrors.
Turn turn_by(double degrees) {
    int quarters = 0;
    const double rest = std::remquo(degrees, 90.0, &quarters);
    const double c = std::cos(rest * kDegree), s = std::sin(rest * kDegree);
    switch (quarters & 3) {
        case 0: return {c, s};
        case 1: return {-s, c};
        case 2: return {-c, -s};
        default: return {s, -c};
    }
}

/// Angle in degrees, exact for 0 and all right angles.
double degrees_of(double sin, double cos) {
    if (sin == 0) return cos < 0 ? 180 : 0;
    if (cos == 0) return std::copysign(90.0, sin);
    return std::atan2(sin, cos) / kDegree;
}

}  // namespace

Affine<double> SurfacePlacement::frame() const {
    const Turn a = turn_by(tilt_deg.x), b = turn_by(tilt_deg.y), c = turn_by(tilt_deg.z);
    const Affine<double> about_x{{1, 0, 0}, {0, a.cos, a.sin}, {0, -a.sin, a.cos}, decentre},
        about_y{{b.cos, 0, -b.sin}, {0, 1, 0}, {b.sin, 0, b.cos}, {0, 0, 0}},
        about_z{{c.cos, c.sin, 0}, {-c.sin, c.cos, 0}, {0, 0, 1}, {0, 0, 0}};
    return about_x * about_y * about_z;
}

SurfacePlacement SurfacePlacement::of(const Affine<double>& frame) {
    SurfacePlacement result;
    result.decentre = frame.origin;
    const double cos_y = hypotenuse(frame.x.x, frame.y.x);
    result.tilt_deg.y = degrees_of(frame.z.x, cos_y);
    constexpr double kLocked = 1e-12;
    if (cos_y < kLocked) {
        result.tilt_deg.x = degrees_of(frame.y.z, frame.y.y);
        return result;
    }
    result.tilt_deg.x = degrees_of(-frame.z.y, frame.z.z);
    result.tilt_deg.z = degrees_of(-frame.y.x, frame.x.x);
    return result;
}

Affine<double> inverse_motion(const Affine<double>& motion) {
    const Vec3d &x = motion.x, &y = motion.y, &z = motion.z;
    Affine<double> inverse{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}, {0, 0, 0}};
    inverse.origin = -inverse.direction(motion.origin);
    return inverse;
}

}  // namespace realcam
