#pragma once
#include <vector>

#include "../../checkpoint.hpp"
#include "lens_prescription.hpp"

namespace realcam::io {

/// Greatest distance from the axis at which rays hit each surface, mm.
struct RayRims {
    std::vector<double> semi_diameters;
    bool all_rays_pass = true;
};

/// Returns the semi-diameters that the axial bundle and those of all fields need. Each bundle consists of its chief ray
/// and the rays at the edges of the stop, reduced by the field's vignetting factors. The lens's stop must have its
/// size; its other rims may be 0. `object_distance`: to the front vertex, mm.
RayRims rims_of_rays(const LensSystem& lens, double object_distance, FieldKind kind,
                     const std::vector<PrescriptionField>& fields, Checkpoint& checkpoint);

/// Returns the greatest distance from the axis, mm, at which rays of the fields hit each surface if they pass all rims
/// of the lens.
RayRims reach_of_rays(const LensSystem& lens, double object_distance, FieldKind kind,
                      const std::vector<PrescriptionField>& fields, Checkpoint& checkpoint);

/// Returns the angle of the chief ray of a field of this size, radians, by first-order optics.
double field_angle_of(const LensSystem& lens, double object_distance, FieldKind kind, double size);

/// Returns the largest image height of the fields, mm, by real chief rays; by first-order optics if there is no such
/// ray.
double largest_image_height(const LensSystem& lens, double object_distance, FieldKind kind,
                            const std::vector<PrescriptionField>& fields);

}  // namespace realcam::io
