#pragma once
#include <string>
#include <string_view>

#include "lens_file.hpp"
#include "lens_glass.hpp"
#include "lens_prescription.hpp"

namespace realcam::io {

// Readers of other programs' lens files. Each takes the text as UTF-8, throws LensFileError with line and surface for
// errors in it, and lists the features that realcam does not model.

/// Zemax OpticStudio, .zmx.
Prescription read_zemax(std::string_view text, const std::string& file, LensGlasses& glasses);
/// CODE V, .seq.
Prescription read_code_v(std::string_view text, const std::string& file, LensGlasses& glasses);
/// OSLO, .len.
Prescription read_oslo(std::string_view text, const std::string& file, LensGlasses& glasses);
/// pbrt, .dat.
Prescription read_pbrt(std::string_view text, const std::string& file, LensGlasses& glasses);
/// Optiland's JSON.
Prescription read_optiland(std::string_view text, const std::string& file, LensGlasses& glasses);
/// ray-optics, .roa.
Prescription read_ray_optics(std::string_view text, const std::string& file, LensGlasses& glasses);

/// Builds the lens that a file of another program states. Dummy surfaces, with the same medium on both sides, are
/// merged, and their thicknesses added. A stop on a surface that bends light becomes a plane at its vertex. The size of
/// the stop is computed from the file's aperture by first-order optics, and that of the film from its fields. Clear
/// semi-diameters that the file omits are computed from real rays. Throws LensFileError if the lens cannot be built, or
/// has unsupported features and is not forced.
LensSystem lens_from(Prescription prescription, const LensReadOptions& options);

// Writers.
LensText lens_as_zemax(const LensSystem& lens);
LensText lens_as_code_v(const LensSystem& lens);
LensText lens_as_optiland(const LensSystem& lens);
LensText lens_as_ray_optics(const LensSystem& lens);

/// Returns a number with the fewest digits that restore the same double.
std::string exact_number(double value);

/// Parses "after" or "before". Throws InputError.
PbrtThickness pbrt_thickness_named(const std::string& name);

}  // namespace realcam::io
