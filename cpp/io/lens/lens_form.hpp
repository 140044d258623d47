#pragma once
#include <string>

#include "../../optics/prescription/surface.hpp"
#include "../text/toml_table.hpp"

namespace realcam::io {

/// What a surface's table says of its form. Throws LensFileError.
SurfaceForm read_form(const TomlTable& table);

/// And of the shape of its aperture. `rim`: clear semi-diameter, to which the arms of a spider go.
ApertureShape read_aperture(const TomlTable& table, double rim);

/// Lines of a surface's table, from which the readers make the same form and shape.
std::string form_as_toml(const SurfaceForm& form);
std::string aperture_as_toml(const ApertureShape& shape);

}  // namespace realcam::io
