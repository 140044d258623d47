#pragma once
#include <cstddef>
#include <vector>

#include "lens_rows.hpp"

namespace realcam::io {

/// A lens in one of the zoom positions of its file, and how far the object is from its first vertex, mm.
struct LensState {
    LensSystem lens;
    double object_distance;
};

/// `lens` has the surfaces of the rows that are kept; thicknesses, film and stop are those of the state. Rims need not
/// be known. Throws LensFileError where the size of the stop follows from nothing.
LensState lens_state(const Prescription& p, const std::vector<KeptRow>& kept, LensSystem lens, std::size_t state);

/// The lens that zooms between its states.
LensSystem joined_states(const Prescription& p, const std::vector<LensState>& states);

}  // namespace realcam::io
