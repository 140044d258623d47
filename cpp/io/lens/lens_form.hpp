#pragma once
#include <string>

#include "../../optics/prescription/surface.hpp"
#include "../text/toml_table.hpp"

namespace realcam::io {

/// Reads the form of a surface from its table. Throws LensFileError.
SurfaceForm read_form(const TomlTable& table);

/// Reads the shape of a surface's aperture from its table. `rim`: clear semi-diameter, to which the arms of a spider
/// extend. Throws LensFileError.
ApertureShape read_aperture(const TomlTable& table, double rim);

/// Return lines of a surface's table, from which the readers restore the form and the aperture shape.
std::string form_as_toml(const SurfaceForm& form);
std::string aperture_as_toml(const ApertureShape& shape);

}  // namespace realcam::io
