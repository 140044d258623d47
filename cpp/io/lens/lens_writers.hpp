#pragma once
#include <string>
#include <vector>

#include "lens_file.hpp"

namespace realcam::io {

/// realcam's own format: the same lens is read again.
std::string lens_as_toml(const LensSystem& lens);
/// Zemax OpticStudio, .zmx.
LensText lens_as_zemax(const LensSystem& lens);
/// CODE V, .seq.
LensText lens_as_code_v(const LensSystem& lens);
/// Optiland's JSON.
LensText lens_as_optiland(const LensSystem& lens);
/// ray-optics, .roa.
LensText lens_as_ray_optics(const LensSystem& lens);

/// Indices of a glass at lines of the spectrum, sorted, among them the wavelength of a lens.
std::vector<Glass::TablePoint> indices_at_lines(const Glass& glass, double wavelength_nm);

/// A number in as few digits as read again give the same double.
std::string exact_number(double value);

/// What no format of other programs has a word for: coatings, blades of the iris, focusing.
std::vector<std::string> left_out_of_foreign_files(const LensSystem& lens, const std::string& format);

}  // namespace realcam::io
