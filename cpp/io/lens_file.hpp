#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "../optics/lens_system.hpp"

namespace realcam::io {

/// Names of the bundled lenses, sorted.
std::vector<std::string> lens_names();

/// The text of a bundled lens file. Throws LensFileError, with the nearest names, where there is none.
std::string_view bundled_lens_text(const std::string& name);

/// Reads a lens: a bundled one by name, or a .toml file by its path (anything with a '/' or a '.').
/// The lens is focused at infinity, or as its file says, and wide open.
/// Throws LensFileError, naming file, line and surface.
LensSystem read_lens(const std::string& name_or_path);

/// Reads a lens from the text of a lens file (format 1, described in lenses/README.md).
/// `file` is what messages call it.
LensSystem parse_lens(std::string_view text, const std::string& file);

/// A glass of the catalogue: "N-BK7", or "schott:F4" where makers share a name.
/// Throws InputError where the name is unknown (with the nearest names) or stands for several glasses.
Glass catalogue_glass(const std::string& name);

}  // namespace realcam::io
