#pragma once
#include <optional>
#include <string>

#include "lens_prescription.hpp"

namespace realcam::io {

/// Converts the aspheric terms of a row to those of the core: r^4 to r^18. A term of r^2 is folded into the curvature
/// (see the source), accurately up to `height`, the clear semi-diameter. Returns the terms that cannot be expressed,
/// for a message, or an empty string.
std::string set_aspheric_terms(const PrescriptionSurface& row, double height, Surface& surface);

}  // namespace realcam::io
