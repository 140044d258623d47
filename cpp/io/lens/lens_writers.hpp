#pragma once
#include <string>
#include <vector>

#include "lens_file.hpp"

namespace realcam::io {

/// Writes realcam's own format, which preserves the lens exactly.
std::string lens_as_toml(const LensSystem& lens);
/// Zemax OpticStudio, .zmx.
LensText lens_as_zemax(const LensSystem& lens);
/// CODE V, .seq.
LensText lens_as_code_v(const LensSystem& lens);
/// Optiland's JSON.
LensText lens_as_optiland(const LensSystem& lens);
/// ray-optics, .roa.
LensText lens_as_ray_optics(const LensSystem& lens);

/// Returns the indices of a glass at spectral lines and at the wavelength of a lens, sorted.
std::vector<Glass::TablePoint> indices_at_lines(const Glass& glass, double wavelength_nm);

/// Returns a number with the fewest digits that restore the same double.
std::string exact_number(double value);

/// Returns warnings for properties that other programs' formats lack: coatings, blades of the iris, focusing.
std::vector<std::string> left_out_of_foreign_files(const LensSystem& lens, const std::string& format);

}  // namespace realcam::io
