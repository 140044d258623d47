#pragma once
#include "lens_prescription.hpp"
#include "lens_states.hpp"

namespace realcam::io {

/// True if a row is tilted or decentred relative to the axis before it, or the axis after it relative to the row.
bool is_moved(const PrescriptionSurface& row);

/// Sets the placements of the surfaces of a lens, which was made from the kept rows as if it were centred, and of the
/// film. Coordinate breaks of rows that were not kept are added to the next surface. If the film's axis is at 60
/// degrees or more to the last axis, an auxiliary plane that blocks nothing is inserted before it.
void set_placements(const Prescription& prescription, const std::vector<KeptRow>& kept, LensSystem& lens);

/// Sets the film's curvature to that of the image surface.
void set_film(const Prescription& prescription, LensSystem& lens);

}  // namespace realcam::io
