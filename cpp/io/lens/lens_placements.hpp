#pragma once
#include "lens_configurations.hpp"
#include "lens_prescription.hpp"

namespace realcam::io {

/// True if a row is tilted or decentred relative to the axis before it, or the axis after it relative to the row.
bool is_displaced(const PrescriptionSurface& row);

/// Sets the placements of the surfaces of a lens, which was made from `surface_rows` as if it were centred, and of the
/// film. Coordinate breaks of other rows are added to the next surface. If the film's axis is at 60
/// degrees or more to the last axis, an auxiliary plane that blocks nothing is inserted before it.
void set_placements(const Prescription& prescription, const std::vector<SurfaceRow>& surface_rows, LensSystem& lens);

/// Sets the film's curvature to that of the image surface.
void set_film(const Prescription& prescription, LensSystem& lens);

}  // namespace realcam::io
