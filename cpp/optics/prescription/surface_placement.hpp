#pragma once
#include "../../math/affine.hpp"

namespace REALCAM_NAMESPACE {

/// Position and orientation of a surface relative to the axis that leads to it: a coordinate break in front of it.
///
/// The vertex is moved by `decentre`. There the surface is rotated about the x axis, then about the rotated y axis,
/// then about its new z axis, each counterclockwise as seen from the tip of the axis. That is Zemax's coordinate break
/// with order 0; CODE V counts the first two angles with the opposite sign.
struct SurfacePlacement {
    Vec3d decentre = {0, 0, 0};  ///< mm
    Vec3d tilt_deg = {0, 0, 0};
    bool returns = false;  ///< true: only this surface moves; false: the axis continues from it, with all that follows

    bool operator==(const SurfacePlacement&) const = default;

    bool is_in_place() const { return decentre == Vec3d{0, 0, 0} && tilt_deg == Vec3d{0, 0, 0}; }

    /// Transform from the frame of the surface to that of the axis in front of it.
    Affine<double> frame() const;

    /// Returns the placement with this rigid frame. If the tilt about y is 90 degrees (gimbal lock), rotations about x
    /// and z are equivalent, and all of it is assigned to x.
    static SurfacePlacement of(const Affine<double>& frame);
};

/// Translation by `distance` along z.
inline Affine<double> along_axis(double distance) {
    return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, distance}};
}

/// Returns the inverse of a rigid motion.
Affine<double> inverse_motion(const Affine<double>& motion);

}  // namespace REALCAM_NAMESPACE
