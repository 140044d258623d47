#pragma once
#include <algorithm>
#include <vector>

#include "../../math/affine.hpp"
#include "aperture_shape.hpp"
#include "coating.hpp"
#include "surface_form.hpp"

namespace REALCAM_NAMESPACE {

/// Position and orientation of a surface relative to the axis that leads to it: a coordinate break in front of it.
///
/// The vertex is moved by `decentre`. There the surface is rotated about the x axis, then about the rotated y axis,
/// then about its new z axis, each counterclockwise as seen from the tip of the axis. That is Zemax's coordinate break
/// with order 0; CODE V counts the first two angles with the opposite sign.
struct SurfacePlacement {
    Vec3d decentre = {0, 0, 0};  ///< mm
    Vec3d tilt_deg = {0, 0, 0};  ///< rotations about x, y and z
    /// True: only this surface moves, and the axis behind it is the one in front of it. False: the axis behind the
    /// surface is the surface's own z axis, so that all surfaces that follow move with it.
    bool returns = false;

    bool operator==(const SurfacePlacement&) const = default;

    /// True if the surface is neither tilted nor decentred.
    bool is_in_place() const { return decentre == Vec3d{0, 0, 0} && tilt_deg == Vec3d{0, 0, 0}; }

    /// Transform from the frame of the surface to that of the axis in front of it, whose origin is the vertex before
    /// the placement.
    Affine<double> frame() const;

    /// Returns the placement whose frame() is this rigid transform. If the tilt about y is 90 degrees (gimbal lock),
    /// rotations about x and z are equivalent, and all of it is assigned to x.
    static SurfacePlacement from_frame(const Affine<double>& frame);
};

/// Returns the translation by `distance` along z.
inline Affine<double> along_axis(double distance) {
    return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, distance}};
}

/// Returns the inverse of a rigid motion.
Affine<double> inverse_motion(const Affine<double>& motion);

/// Effect of a surface on light.
enum class SurfaceType {
    refracting,
    mirror,  ///< reverses the light: thicknesses after it are negative until the next mirror
    stop,  ///< the aperture stop, a plane
    aperture,  ///< a plane that only blocks light: a rim, or the obstruction by a secondary mirror
};

/// One row of a lens table. Lengths in mm, lens frame.
struct Surface {
    SurfaceType type = SurfaceType::refracting;
    double curvature = 0;  ///< 1/mm; positive if the centre lies on the film side; 0: plane
    double conic = 0;  ///< k: 0 sphere, -1 paraboloid
    std::vector<double> aspheric;  ///< coefficients of r^4, r^6, ..., mm^-3, mm^-5, ...
    double thickness = 0;  ///< distance to the next vertex along the axis; 0 for the last surface
    Glass material = Glass::air();  ///< medium behind the surface, for light that travels to the film
    double clear_semi_diameter = 0;
    double inner_semi_diameter = 0;  ///< radius of a central hole or obstruction, which blocks light; 0: none
    Coating coating;
    SurfacePlacement placement;
    SurfaceForm form;  ///< sag terms beyond the conic and the even aspheric terms
    ApertureShape aperture_shape;  ///< open part of the circle of the clear semi-diameter

    bool operator==(const Surface&) const = default;

    /// True if the surface refracts or reflects; false for a stop or an aperture.
    bool bends_light() const { return type == SurfaceType::refracting || type == SurfaceType::mirror; }
    /// True if an even aspheric coefficient is not 0.
    bool is_asphere() const {
        return std::any_of(aspheric.begin(), aspheric.end(), [](double a) { return a != 0; });
    }

    /// Returns the reason why a lens with this surface is not rotationally symmetric, for example "is tilted";
    /// empty if it may be one.
    std::string asymmetry() const;

    /// z of the surface above the point (x, y) of its vertex plane, mm; NaN beyond the edge of the conic.
    double sag(double x, double y) const;
    /// Sag at a radial distance, mm; for a surface without rotational symmetry, in its yz plane.
    double sag(double radius) const { return sag(0, radius); }
    /// Curvature at the vertex, 1/mm, including terms of r^2. For surfaces of revolution only.
    double vertex_curvature() const;
};

}  // namespace REALCAM_NAMESPACE
