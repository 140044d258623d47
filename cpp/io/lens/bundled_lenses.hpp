#pragma once
// The files of lenses/ as they were when the library was built; the definitions are generated.

#include <span>
#include <string_view>

#include "../files/bundled_file.hpp"

namespace realcam::io {

// Every bundled lens, in the order of the file names.
std::span<const BundledFile> bundled_lens_files();

// The glass catalogue, lenses/glass.toml; empty where there is none.
std::string_view bundled_glass_catalogue();

}  // namespace realcam::io
