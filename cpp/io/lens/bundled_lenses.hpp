#pragma once
// Files of lenses/, compiled into the library; the definitions are generated.

#include <span>
#include <string_view>

#include "../files/bundled_file.hpp"

namespace realcam::io {

// Returns the bundled lenses, in the order of the file names.
std::span<const BundledFile> bundled_lens_files();

// Returns the glass catalogue, lenses/glass.toml; empty if there is no catalogue.
std::string_view bundled_glass_catalogue();

}  // namespace realcam::io
