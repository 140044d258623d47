#pragma once
#include <cstddef>
#include <vector>

#include "lens_rows.hpp"

namespace realcam::io {

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
