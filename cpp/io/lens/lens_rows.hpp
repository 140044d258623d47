#pragma once
#include <cstddef>
#include <vector>

#include "lens_prescription.hpp"

namespace realcam::io {

/// Which rows of the file became surfaces of the lens. One that is a stop and bends light is two of them.
struct KeptRow {
    std::size_t row;
    SurfaceType type;
};

/// The lens's surfaces: what bends or blocks light. The others, with one medium on both sides, only add their thickness
/// to what stands before them.
std::vector<KeptRow> kept_rows(const Prescription& p);

}  // namespace realcam::io
