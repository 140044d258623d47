#pragma once
#include <cstddef>
#include <vector>

#include "lens_prescription.hpp"

namespace realcam::io {

/// A row of the file that became a surface of the lens. A stop that bends light becomes two surfaces.
struct KeptRow {
    std::size_t row;
    SurfaceType type;
};

/// Returns the rows that bend or block light. The others, with the same medium on both sides, only add their thickness
/// to the surface before them.
std::vector<KeptRow> kept_rows(const Prescription& p);

/// A lens in one of the zoom positions of its file, and the distance of the object from its first vertex, mm.
struct LensState {
    LensSystem lens;
    double object_distance;
};

/// Returns the lens of a zoom position. `lens` has the surfaces of the kept rows; thicknesses, film and stop are those
/// of the position. Rims need not be known. Throws LensFileError if the size of the stop cannot be determined.
LensState lens_state(const Prescription& p, const std::vector<KeptRow>& kept, LensSystem lens, std::size_t state);

/// Returns the zoom lens with these positions.
LensSystem joined_states(const Prescription& p, const std::vector<LensState>& states);

}  // namespace realcam::io
