#pragma once
#include "lens_prescription.hpp"
#include "lens_rows.hpp"

namespace realcam::io {

/// Whether a row of the table is moved from the axis in front of it, or the axis behind from the row.
bool is_moved(const PrescriptionSurface& row);

/// What CODE V and ray-optics do with a decentre.
enum class DecentreKind {
    ordinary,    ///< in front of the surface: the axis goes on from it
    and_return,  ///< and undone behind it
    bend,        ///< and its tilts once more behind it, as a mirror turns light
    reverse,     ///< undone behind the surface alone
};
void set_decentre(const SurfacePlacement& placement, DecentreKind kind, PrescriptionSurface& row);

/// Turns a toroid about its axis by 90 degrees, so that its section with conic and terms lies in the xz plane. Its
/// place and its aperture, which have to be known, stay as they are.
void turn_about_axis(PrescriptionSurface& row);

/// Gives the surfaces of a lens, made of the kept rows as if it were centred, and the film their places. The breaks of
/// rows that were not kept go to the next one. Before a film that looks another way than the last axis, a plane is put
/// that blocks nothing.
void set_places(const Prescription& prescription, const std::vector<KeptRow>& kept, LensSystem& lens);

/// Gives the film the curvature of the image surface.
void set_film(const Prescription& prescription, LensSystem& lens);

}  // namespace realcam::io
