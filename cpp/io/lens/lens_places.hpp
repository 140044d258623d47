#pragma once
#include "lens_prescription.hpp"
#include "lens_rows.hpp"

namespace realcam::io {

/// True if a row is tilted or decentred relative to the axis before it, or the axis after it relative to the row.
bool is_moved(const PrescriptionSurface& row);

/// Types of decentre in CODE V and ray-optics.
enum class DecentreKind {
    ordinary,    ///< before the surface: the axis continues from it
    and_return,  ///< before the surface, and reversed after it
    bend,        ///< before the surface, and its tilts again after it, as a mirror folds the axis
    reverse,     ///< only reversed after the surface
};
void set_decentre(const SurfacePlacement& placement, DecentreKind kind, PrescriptionSurface& row);

/// Rotates a toroid about its axis by 90 degrees, so that its section with conic and terms lies in the xz plane. Its
/// placement and its aperture, which must be known, are compensated.
void turn_about_axis(PrescriptionSurface& row);

/// Sets the placements of the surfaces of a lens, which was made from the kept rows as if it were centred, and of the
/// film. Coordinate breaks of rows that were not kept are added to the next surface. If the film's axis is at 60
/// degrees or more to the last axis, an auxiliary plane that blocks nothing is inserted before it.
void set_places(const Prescription& prescription, const std::vector<KeptRow>& kept, LensSystem& lens);

/// Sets the film's curvature to that of the image surface.
void set_film(const Prescription& prescription, LensSystem& lens);

}  // namespace realcam::io
