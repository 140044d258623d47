#pragma once
#include <string>
#include <string_view>

#include "lens_file.hpp"

namespace realcam::io {

/// Formats of lens files.
enum class LensFormat { toml, zemax, code_v, oslo, pbrt, optiland, ray_optics };

/// By the suffix of a file's name, in any case. What is no other program's is realcam's own, TOML.
LensFormat lens_format_of(std::string_view path);

/// All suffixes that are read, in a sentence.
inline constexpr const char* kLensSuffixes = ".toml, .zmx, .seq, .len, .dat, .json or .roa";

/// "after" or "before". Throws InputError.
PbrtThickness pbrt_thickness_named(const std::string& name);

}  // namespace realcam::io
