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

}  // namespace realcam::io
