#pragma once
#include <string>
#include <string_view>

#include "lens_file.hpp"

namespace realcam::io {

/// Formats of lens files.
enum class LensFormat { toml, zemax, code_v, pbrt, optiland, ray_optics };

/// By the suffix of a file's name, in any case. What is no other program's is realcam's own, TOML.
LensFormat lens_format_of(std::string_view path);

/// "after" or "before". Throws InputError.
PbrtThickness pbrt_thickness_named(const std::string& name);

}  // namespace realcam::io
