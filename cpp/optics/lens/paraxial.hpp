#pragma once
#include <cmath>

#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// A paraxial ray at a plane: height in mm, slope = tangent of the angle to the axis.
struct ParaxialRay {
    double height;
    double slope;
};

/// A sum of two terms that is no larger than what rounding has left of them is zero: the power of an afocal system, the
/// height at a stop in a focal plane. A telescope would have a focal length of 1e18 mm else.
double sum_or_zero(double a, double b);

/// Across a surface: n' u' = n u - y c (n' - n). Indices have the sign of the light's direction along z, so that a
/// mirror is n' = -n.
inline ParaxialRay refract_paraxial(ParaxialRay ray, double curvature, double before, double after) {
    return {ray.height, sum_or_zero(before * ray.slope, -ray.height * curvature * (after - before)) / after};
}

/// Traces a paraxial ray over the surfaces [first, last) in the direction of the light, from the vertex of the first
/// to the vertex of the last one. Throws InputError where the lens is no centred one of revolution.
ParaxialRay trace_paraxial(const LensSystem& lens, double wavelength_nm, ParaxialRay ray, int first, int last);

/// First-order data at one wavelength. Positions in the lens frame (from the front vertex), mm.
/// An afocal system has an infinite focal length, distances and f-number; a stop in a focal plane has a pupil of
/// infinite size at infinity, and a closed one a pupil of size 0.
struct FirstOrder {
    double effective_focal_length;  ///< 1 / power, the front focal length: of an image space in air also the rear one
    double back_focal_distance;  ///< last vertex to the rear focal point
    double front_focal_distance;  ///< front vertex to the front focal point, negative in front of it
    double f_number;  ///< focal length over entrance pupil diameter, object at infinity
    double entrance_pupil_position, entrance_pupil_diameter;
    double exit_pupil_position, exit_pupil_diameter;
    double film_distance;
    double image_index;  ///< index of image space; the rear focal length is this times the effective one

    bool is_afocal() const { return std::isinf(effective_focal_length); }
};

/// Of a centred lens of revolution by paraxial rays; how all of it is tilted or shifted before the film changes
/// nothing. Of any other lens by rays close to the chief ray of the film's middle: the means of both meridians
/// (parabasal.hpp). Throws InputError where there is no such ray.
FirstOrder first_order(const LensSystem& lens, double wavelength_nm);

/// For what only describes a lens, at its design wavelength: where it has no first-order data, those of the lens with
/// all its surfaces in place on one axis.
FirstOrder nominal_first_order(const LensSystem& lens);

/// Last vertex to the paraxial image of an axial point `object_distance` mm in front of the front vertex.
double paraxial_image_distance(const LensSystem& lens, double wavelength_nm, double object_distance);

}  // namespace REALCAM_NAMESPACE
