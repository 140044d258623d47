#pragma once
#include "lens_file.hpp"
#include "lens_prescription.hpp"

namespace realcam::io {

/// Builds the lens that a file of another program states. Dummy surfaces, with the same medium on both sides, are
/// merged, and their thicknesses added. A stop on a surface that bends light becomes a plane at its vertex. The size of
/// the stop is computed from the file's aperture by first-order optics, and that of the film from its fields. Clear
/// semi-diameters that the file omits are computed from real rays. Throws LensFileError if the lens cannot be built, or
/// has unsupported features and is not forced.
LensSystem lens_from(Prescription prescription, const LensReadOptions& options);

}  // namespace realcam::io
