#pragma once
#include <string>
#include <string_view>

#include "lens_glass.hpp"
#include "lens_prescription.hpp"

namespace realcam::io {

// Readers of other programs' lens files. Each takes the text as UTF-8, throws LensFileError with line and surface for
// errors in it, and lists the features that realcam does not model.

/// Zemax OpticStudio, .zmx.
Prescription read_zemax(std::string_view text, const std::string& file, LensGlasses& glasses);

/// CODE V, .seq.
Prescription read_code_v(std::string_view text, const std::string& file, LensGlasses& glasses);

/// pbrt, .dat.
Prescription read_pbrt(std::string_view text, const std::string& file, const LensReadOptions& options);

/// OSLO, .len.
Prescription read_oslo(std::string_view text, const std::string& file, LensGlasses& glasses);

/// Optiland's JSON.
Prescription read_optiland(std::string_view text, const std::string& file, LensGlasses& glasses);

/// ray-optics, .roa.
Prescription read_ray_optics(std::string_view text, const std::string& file, LensGlasses& glasses);

}  // namespace realcam::io
