#pragma once
#include <cstddef>
#include <vector>

#include "lens_prescription.hpp"

namespace realcam::io {

/// Row of a prescription that becomes a surface of the lens. A stop on a surface that bends light becomes two surfaces.
struct SurfaceRow {
    std::size_t row;  ///< index in Prescription::surfaces
    SurfaceType type;
};

/// Returns the rows that bend or block light, in order. The other rows, with the same medium on both sides, only add
/// their thickness to the surface before them.
std::vector<SurfaceRow> surface_rows(const Prescription& p);

/// Lens in one of the zoom positions of its file.
struct LensConfiguration {
    LensSystem lens;
    double object_distance;  ///< from the object to the first vertex, mm
};

/// Returns the lens of a zoom position. `lens` has the surfaces of the rows; their thicknesses, the film distance and
/// the stop's size are set for the position. Rims need not be known. Throws LensFileError if the size of the stop
/// cannot be determined.
LensConfiguration lens_configuration(const Prescription& p, const std::vector<SurfaceRow>& surface_rows,
                                     LensSystem lens, std::size_t position);

/// Returns the zoom lens with these positions; the only lens if the file has no zoom positions.
LensSystem joined_configurations(const Prescription& p, const std::vector<LensConfiguration>& configurations);

}  // namespace realcam::io
