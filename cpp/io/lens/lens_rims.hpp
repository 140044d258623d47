#pragma once
#include <vector>

#include "../../checkpoint.hpp"
#include "lens_prescription.hpp"

namespace realcam::io {

/// How far from the axis rays meet each surface, mm.
struct RayRims {
    std::vector<double> semi_diameters;
    bool all_rays_pass = true;
};

/// The rims that the axial bundle and those of all fields need. Each bundle has its chief ray and the rays at the edges
/// of the stop, less what the field's vignetting factors cut off. The lens's stop must have its size; its other rims
/// may be 0. `object_distance`: to the front vertex, mm.
RayRims rims_of_rays(const LensSystem& lens, double object_distance, FieldKind kind,
                     const std::vector<PrescriptionField>& fields, Checkpoint& checkpoint);

/// How far from the axis rays of the fields meet each surface if they pass all rims of the lens, mm.
RayRims reach_of_rays(const LensSystem& lens, double object_distance, FieldKind kind,
                      const std::vector<PrescriptionField>& fields, Checkpoint& checkpoint);

/// The angle at which the chief ray of a field of this size comes, radians, by first-order optics.
double field_angle_of(const LensSystem& lens, double object_distance, FieldKind kind, double size);

/// The largest image height of the fields, mm, by real chief rays. Where there is no such ray, first-order optics is
/// used.
double largest_image_height(const LensSystem& lens, double object_distance, FieldKind kind,
                            const std::vector<PrescriptionField>& fields);

}  // namespace realcam::io
