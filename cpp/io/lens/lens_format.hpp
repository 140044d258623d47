#pragma once
#include <string>
#include <string_view>

#include "lens_file.hpp"
#include "lens_glass.hpp"
#include "lens_prescription.hpp"

namespace realcam::io {

// Readers of other programs' lens files, which convert the file's text (UTF-8) to a Prescription. `file`: its name in
// messages. They throw LensFileError with line and surface for errors in the text, and record features that realcam
// does not model in Prescription::unsupported.

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

/// Builds the lens that a file of another program describes. Dummy surfaces, with the same medium on both sides, are
/// merged, and their thicknesses added. A stop on a surface that bends light becomes a plane at its vertex. The size of
/// the stop is computed from the file's aperture by first-order optics, and that of the film from its fields. Clear
/// semi-diameters that the file omits are computed from real rays. Throws LensFileError if the lens cannot be built, or
/// if it has unsupported features and options.force is not set.
LensSystem lens_from(Prescription prescription, const LensReadOptions& options);

// Writers. Their warnings name the properties of the lens that the format cannot express. OSLO's and pbrt's formats are
// only read.
LensText lens_as_zemax(const LensSystem& lens);
LensText lens_as_code_v(const LensSystem& lens);
LensText lens_as_optiland(const LensSystem& lens);
LensText lens_as_ray_optics(const LensSystem& lens);

/// Formats a number with the fewest digits from which the same double is parsed.
std::string exact_number(double value);

/// Parses "after" or "before": whether the thickness in a row of a pbrt file is that after or before the row's surface.
/// Throws InputError.
PbrtThickness pbrt_thickness_named(const std::string& name);

}  // namespace realcam::io
