#pragma once
// Backward error of a ray behind one surface, which is small for every ray. Shifting a tangent ray by one rounding
// moves its hit far; but the hit's distances from the line and from the surface, and the residual of Snell's law with
// the surface's own normal there, stay of the order of roundings.

#include <algorithm>

#include "optics/oracle.hpp"

namespace realcam::test {

/// In units in the last place: of the scale (the longer of the origin's distance and the semi-diameter), and of 1 for
/// Snell's law.
struct BackwardError {
    double off_line = 0, off_surface = 0, snell = 0;

    void include(const BackwardError& other) {
        off_line = std::max(off_line, other.off_line);
        off_surface = std::max(off_surface, other.off_surface);
        snell = std::max(snell, other.snell);
    }
};

/// By how much of itself the unit normal turns when the point moves by one unit of the scale: 1 for a hemisphere,
/// without bound where a surface ends in a wall.
inline double turning(const OracleSurface& shape, const RealVector& at, double ulp) {
    const Real inwards = 1 - 16 * ulp;
    const RealVector moved{inwards * at.x, inwards * at.y, at.z};
    return static_cast<double>(length(shape.normal(at) - shape.normal(moved))) / (16 * ulp);
}

/// A ray that met `surface`, whose vertex is the origin, on its way from a medium of index `before` to one of `after`.
inline BackwardError backward_error(const Surface& surface, Vec3d origin, Vec3d direction, Vec3d at, Vec3d refracted,
                                    double before, double after, double ulp) {
    const OracleSurface shape(surface);
    const RealVector o = exact(origin), d = normalized(exact(direction)), point = exact(at),
                     normal = shape.normal(point);
    const double scale = std::max(length(origin), surface.clear_semi_diameter);
    const Real amiss = length(before * cross(d, normal) - after * cross(exact(refracted), normal));
    return {static_cast<double>(length(cross(point - o, d))) / (ulp * scale),
            std::fabs(static_cast<double>(shape.distance(point))) / (ulp * scale),
            // The normal is that of a point which is off by some units.
            static_cast<double>(amiss) / (ulp * std::max(1.0, turning(shape, point, ulp)))};
}

}  // namespace realcam::test
