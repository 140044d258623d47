#pragma once
#include "lens_file.hpp"
#include "lens_prescription.hpp"

namespace realcam::io {

/// The lens that a file of another program states. Dummy surfaces, with the same medium on both sides, are merged away
/// with their thicknesses. A stop on a surface that bends light becomes a plane at its vertex. The stop's size follows
/// from the file's aperture by first-order optics, and the film's from its fields. Clear semi-diameters that the file
/// leaves out follow from real rays. Throws LensFileError for what cannot be built, or is foreign and not forced.
LensSystem lens_from(Prescription prescription, const LensReadOptions& options);

}  // namespace realcam::io
