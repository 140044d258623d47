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

/// Of the axial bundle and those of all fields, each by its chief ray and the rays at the edges of the stop, less what
/// the fields' vignetting factors cut off. The lens's stop has its size; its other rims may be 0.
/// `object_distance`: to the front vertex, mm.
RayRims rims_of_rays(const LensSystem& lens, double object_distance, FieldKind kind,
                     const std::vector<PrescriptionField>& fields, Checkpoint& checkpoint);

/// Of the fields, on the film, mm: by real chief rays, and where there is none by first-order optics.
double largest_image_height(const LensSystem& lens, double object_distance, FieldKind kind,
                            const std::vector<PrescriptionField>& fields);

}  // namespace realcam::io
