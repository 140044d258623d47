#pragma once
#include <vector>

#include "../../checkpoint.hpp"
#include "lens_prescription.hpp"

namespace realcam::io {

/// Greatest heights of rays at the surfaces of a lens.
struct RayHeights {
    std::vector<double> semi_diameters;  ///< greatest distance from the axis by surface, mm
    bool all_rays_pass = true;  ///< false if a ray could not be traced
};

/// Returns the semi-diameters that the axial bundle and those of all fields need. Each bundle consists of its chief ray
/// and the rays at the edges of the stop, reduced by the field's vignetting factors. The lens's stop must have its
/// size; its other rims may be 0. `object_distance`: to the front vertex, mm.
RayHeights required_semi_diameters(const LensSystem& lens, double object_distance, FieldKind kind,
                                   const std::vector<PrescriptionField>& fields, Checkpoint& checkpoint);

/// Returns the heights of only those rays of the fields that pass all rims of the lens.
RayHeights passing_ray_heights(const LensSystem& lens, double object_distance, FieldKind kind,
                               const std::vector<PrescriptionField>& fields, Checkpoint& checkpoint);

/// Returns the angle of the chief ray in object space, radians, by first-order optics. `size`: of the field, in degrees
/// or mm (see FieldKind). `object_distance`: to the front vertex, mm.
double field_angle_of(const LensSystem& lens, double object_distance, FieldKind kind, double size);

/// Returns the largest image height of the fields, mm, by real chief rays; by first-order optics if there is no such
/// ray.
double largest_image_height(const LensSystem& lens, double object_distance, FieldKind kind,
                            const std::vector<PrescriptionField>& fields);

}  // namespace realcam::io
