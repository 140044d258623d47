#pragma once
#include <algorithm>
#include <vector>

#include "aperture_shape.hpp"
#include "coating.hpp"
#include "surface_form.hpp"
#include "surface_placement.hpp"

namespace REALCAM_NAMESPACE {

enum class SurfaceType {
    refracting,
    mirror,  ///< reverses the light: thicknesses after it are negative until the next mirror
    stop,  ///< the aperture stop, a plane
    aperture,  ///< a plane that only blocks light: a rim, or the shadow of a secondary mirror
};

/// One row of a lens table. Lengths in mm, lens frame.
struct Surface {
    SurfaceType type = SurfaceType::refracting;
    double curvature = 0;  ///< 1/mm; positive if the centre lies on the film side; 0: plane
    double conic = 0;  ///< k: 0 sphere, -1 paraboloid
    std::vector<double> aspheric;  ///< coefficients of r^4, r^6, ..., mm^-3, mm^-5, ...
    double thickness = 0;  ///< to the next vertex; 0 for the last surface
    Glass material = Glass::air();  ///< medium behind the surface, for light that travels to the film
    double clear_semi_diameter = 0;
    double inner_semi_diameter = 0;  ///< light closer to the axis is blocked; 0: no hole
    Coating coating;
    SurfacePlacement placement;
    SurfaceForm form;  ///< sag terms beyond the conic and the even aspheric terms
    ApertureShape aperture_shape;  ///< open part of the circle of the clear semi-diameter

    bool operator==(const Surface&) const = default;

    bool bends_light() const { return type == SurfaceType::refracting || type == SurfaceType::mirror; }
    bool is_asphere() const {
        return std::any_of(aspheric.begin(), aspheric.end(), [](double a) { return a != 0; });
    }

    /// Reason why a lens with this surface is not a centred lens of revolution: "is tilted"; empty if it may be one.
    std::string asymmetry() const;

    /// Height of the surface over its vertex plane, mm; NaN beyond the edge of the conic.
    double sag(double x, double y) const;
    /// Sag at a radial distance; for a surface without rotational symmetry, in its yz plane.
    double sag(double radius) const { return sag(0, radius); }
    /// Curvature at the vertex, 1/mm, including terms of r^2. For surfaces of revolution only.
    double vertex_curvature() const;
};

}  // namespace REALCAM_NAMESPACE
