#pragma once
#include <cmath>

#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// A paraxial ray at a plane: height in mm, slope = tangent of the angle to the axis.
struct ParaxialRay {
    double height;
    double slope;
};

/// Returns a + b, or 0 if the sum is not larger than its rounding error, as may be the power of an afocal system or the
/// height at a stop in a focal plane. Otherwise a telescope would have a focal length of 1e18 mm.
double sum_or_zero(double a, double b);

/// Returns a ray refracted at a surface: n' u' = n u - y c (n' - n). Indices have the sign of the light's direction
/// along z, so that a mirror is n' = -n. `before`, `after`: n and n'; `curvature`: c, 1/mm.
inline ParaxialRay refract_paraxial(ParaxialRay ray, double curvature, double before, double after) {
    return {ray.height, sum_or_zero(before * ray.slope, -ray.height * curvature * (after - before)) / after};
}

/// Traces a paraxial ray through the surfaces first to last - 1 towards the film. `ray`: the ray at the vertex of the
/// first surface, before it; the result is the ray at the vertex of the last one, behind it. Throws InputError unless
/// all surfaces share one axis of revolution.
ParaxialRay trace_paraxial(const LensSystem& lens, double wavelength_nm, ParaxialRay ray, int first, int last);

/// First-order data at one wavelength. Positions in the lens frame (from the front vertex), mm.
/// An afocal system has an infinite focal length, distances and f-number; a stop in a focal plane has a pupil of
/// infinite size at infinity, and a closed one a pupil of size 0.
struct FirstOrder {
    double effective_focal_length;  ///< 1 / power: the front focal length, and in air also the rear one
    double back_focal_distance;  ///< last vertex to the rear focal point
    double front_focal_distance;  ///< front vertex to the front focal point, negative in front of it
    double f_number;  ///< focal length over entrance pupil diameter, object at infinity; at the current stop
    double entrance_pupil_position, entrance_pupil_diameter;  ///< z from the front vertex, mm; diameter, mm
    double exit_pupil_position, exit_pupil_diameter;  ///< z from the front vertex, mm; diameter, mm
    double film_distance;  ///< last vertex to film
    double image_index;  ///< index of image space; the rear focal length is this times the effective one

    bool is_afocal() const { return std::isinf(effective_focal_length); }
};

/// Returns the first-order data. For a rotationally symmetric lens they are those of paraxial rays; a tilt or shift of
/// the whole lens in front of the film changes nothing. For any other lens they are those of rays close to the chief
/// ray of the film's centre, the means of both meridians (parabasal.hpp). Throws InputError if there is no such chief
/// ray.
FirstOrder first_order(const LensSystem& lens, double wavelength_nm);

/// Returns the first-order data at the design wavelength, for descriptions of a lens. If the lens has no first-order
/// data, returns those of centred(lens).
FirstOrder nominal_first_order(const LensSystem& lens);

/// Returns the distance from the last vertex to the paraxial image of an axial point, mm. `object_distance`: distance
/// of the point in front of the front vertex, mm; may be infinite.
double paraxial_image_distance(const LensSystem& lens, double wavelength_nm, double object_distance);

}  // namespace REALCAM_NAMESPACE
