#pragma once
#include <optional>
#include <string>

#include "lens_prescription.hpp"

namespace realcam::io {

/// Brings the aspheric terms of a row into those of the core: r^4 to r^18. A term of r^2 is folded into the curvature
/// (see the source); `height` is the clear semi-diameter out to which that has to hold. Returns what cannot be
/// expressed, as a message names it; empty where all can.
std::string set_aspheric_terms(const PrescriptionSurface& row, double height, Surface& surface);

}  // namespace realcam::io
