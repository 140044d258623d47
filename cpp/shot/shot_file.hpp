#pragma once
#include <string>
#include <string_view>

#include "shot_request.hpp"

namespace realcam::shot {

/// Reads a shot file (format 1, described in docs/shot-files.md). The paths in it are relative to it. Throws InputError
/// that names file, line and key.
ShotRequest read_shot_file(const std::string& path);

/// The same from the text of a file. `path` is what messages call it, and what its paths are relative to.
ShotRequest parse_shot(std::string_view text, const std::string& path);

}  // namespace realcam::shot
