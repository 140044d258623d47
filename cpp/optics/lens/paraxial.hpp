#pragma once
#include <cmath>

#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// A paraxial ray at a plane: height in mm, slope = tangent of the angle to the axis.
struct ParaxialRay {
    double height;
    double slope;
};

/// Returns a + b, or 0 if the sum is no larger than its rounding error: the power of an afocal system, the height at a
/// stop in a focal plane. Otherwise a telescope would have a focal length of 1e18 mm.
double sum_or_zero(double a, double b);

/// Refraction at a surface: n' u' = n u - y c (n' - n). Indices have the sign of the light's direction along z, so that
/// a mirror is n' = -n.
inline ParaxialRay refract_paraxial(ParaxialRay ray, double curvature, double before, double after) {
    return {ray.height, sum_or_zero(before * ray.slope, -ray.height * curvature * (after - before)) / after};
}

/// Traces a paraxial ray over the surfaces [first, last) in the direction of the light, from the vertex of the first to
/// the vertex of the last one. Throws InputError unless all surfaces share one axis of revolution.
ParaxialRay trace_paraxial(const LensSystem& lens, double wavelength_nm, ParaxialRay ray, int first, int last);

/// First-order data at one wavelength. Positions in the lens frame (from the front vertex), mm.
/// An afocal system has an infinite focal length, distances and f-number; a stop in a focal plane has a pupil of
/// infinite size at infinity, and a closed one a pupil of size 0.
struct FirstOrder {
    double effective_focal_length;  ///< 1 / power: the front focal length, and in air also the rear one
    double back_focal_distance;  ///< last vertex to the rear focal point
    double front_focal_distance;  ///< front vertex to the front focal point, negative in front of it
    double f_number;  ///< focal length over entrance pupil diameter, object at infinity
    double entrance_pupil_position, entrance_pupil_diameter;
    double exit_pupil_position, exit_pupil_diameter;
    double film_distance;
    double image_index;  ///< index of image space; the rear focal length is this times the effective one

    bool is_afocal() const { return std::isinf(effective_focal_length); }
};

/// Returns the first-order data. For a centred lens of revolution they are those of paraxial rays; a tilt or shift of
/// the whole lens in front of the film changes nothing. For any other lens they are those of rays close to the chief
/// ray of the film's centre, the means of both meridians (parabasal.hpp). Throws InputError if there is no such chief
/// ray.
FirstOrder first_order(const LensSystem& lens, double wavelength_nm);

/// First-order data at the design wavelength, for descriptions of a lens. If the lens has no first-order data, returns
/// those of centred(lens).
FirstOrder nominal_first_order(const LensSystem& lens);

/// Distance from the last vertex to the paraxial image of an axial point `object_distance` mm in front of the front
/// vertex, mm.
double paraxial_image_distance(const LensSystem& lens, double wavelength_nm, double object_distance);

}  // namespace REALCAM_NAMESPACE
