#pragma once
#include "../../math/affine.hpp"

namespace REALCAM_NAMESPACE {

/// Where a surface stands, as seen from the axis that leads to it: a coordinate break in front of it.
///
/// The vertex is moved by `decentre`. There the surface is turned about the x axis, then about the y axis that has been
/// turned with it, then about its new z axis, each counterclockwise as seen from the tip of the axis. That is Zemax's
/// coordinate break with order 0; CODE V counts the first two angles the other way.
struct SurfacePlacement {
    Vec3d decentre = {0, 0, 0};  ///< mm
    Vec3d tilt_deg = {0, 0, 0};
    bool returns = false;  ///< only this surface is moved; else the axis goes on from it, with all that follows

    bool operator==(const SurfacePlacement&) const = default;

    bool is_in_place() const { return decentre == Vec3d{0, 0, 0} && tilt_deg == Vec3d{0, 0, 0}; }

    /// From the frame of the surface to that of the axis in front of it.
    Affine<double> frame() const;

    /// With such a frame, a rigid one. Where the y axis is turned by 90 degrees, rotations about x and z are the same:
    /// all of it is given to x.
    static SurfacePlacement of(const Affine<double>& frame);
};

/// The frame that stands farther along the z axis.
inline Affine<double> along_axis(double distance) {
    return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, distance}};
}

/// The inverse of a rigid motion.
Affine<double> inverse_motion(const Affine<double>& motion);

}  // namespace REALCAM_NAMESPACE
