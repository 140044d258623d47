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
    mirror,    ///< light goes back: thicknesses after it are negative until the next mirror
    stop,      ///< the aperture stop, a plane
    aperture,  ///< a plane that only blocks: a rim, or the shadow of a secondary mirror
};

/// One row of a lens table. Lengths in mm, lens frame.
struct Surface {
    SurfaceType type = SurfaceType::refracting;
    double curvature = 0;          ///< 1/mm; positive where the centre lies on the film side; 0: plane
    double conic = 0;              ///< k: 0 sphere, -1 paraboloid
    std::vector<double> aspheric;  ///< coefficients of r^4, r^6, ..., mm^-3, mm^-5, ...
    double thickness = 0;          ///< to the next vertex; of the last surface: 0
    Glass material = Glass::air();  ///< behind the surface, on the light's way to the film
    double clear_semi_diameter = 0;
    double inner_semi_diameter = 0;  ///< light closer to the axis is blocked; 0: none
    Coating coating;
    SurfacePlacement placement;
    SurfaceForm form;              ///< what the sag has beside its conic and its even terms
    ApertureShape aperture_shape;  ///< what is open of the circle of the clear semi-diameter

    bool operator==(const Surface&) const = default;

    bool bends_light() const { return type == SurfaceType::refracting || type == SurfaceType::mirror; }
    bool is_asphere() const {
        return std::any_of(aspheric.begin(), aspheric.end(), [](double a) { return a != 0; });
    }

    /// What keeps a lens with this surface from being a centred one of revolution: "is tilted". Empty: nothing.
    std::string asymmetry() const;

    /// Height of the surface over its vertex plane, mm; NaN past the edge of the conic.
    double sag(double x, double y) const;
    /// The same at a radial distance; of a surface that is not of revolution in its yz plane.
    double sag(double radius) const { return sag(0, radius); }
    /// Curvature at the vertex, 1/mm: terms of r^2 bend the surface too. Of surfaces of revolution.
    double vertex_curvature() const;
};

}  // namespace REALCAM_NAMESPACE
