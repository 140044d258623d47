#pragma once
#include "lens_prescription.hpp"
#include "lens_rows.hpp"

namespace realcam::io {

/// Whether a row of the table is moved from the axis in front of it, or the axis behind from the row.
bool is_moved(const PrescriptionSurface& row);

/// Gives the surfaces of a lens, made of the kept rows as if it were centred, their places. The breaks of rows that
/// were not kept go to the next one; if the film is moved, a plane that blocks nothing is put before it.
void set_places(const Prescription& prescription, const std::vector<KeptRow>& kept, LensSystem& lens);

/// Gives the film the curvature, tilt and decentre of the image surface. Behind an odd number of mirrors a centred lens
/// gets a plane that turns its axis round, so that the film lies behind it.
void set_film_place(const Prescription& prescription, LensSystem& lens);

}  // namespace realcam::io
