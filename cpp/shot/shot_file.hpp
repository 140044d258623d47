#pragma once
#include <string>
#include <string_view>

#include "shot_request.hpp"

namespace realcam::shot {

/// True for a shot file, false for a scene file.
bool is_shot_file(const std::string& path);

/// The request of a shot file (format 1, described in docs/shot-files.md), whose paths are relative to it, or of a
/// scene file alone. `changes`: the text of more keys. They take the place of the same keys of the file and of those
/// that they exclude, also in its tables [[key]]. Throws InputError that names file, line and key.
ShotRequest read_shot(const std::string& path, std::string_view changes = {});

/// The request of a scene that has no shot file. `path`: as of read_shot.
ShotRequest shot_of_scene(const std::string& path, std::string_view changes = {});

/// The same from the text of a shot file. `path` is what messages call it, and what its paths are relative to.
ShotRequest parse_shot(std::string_view text, const std::string& path, std::string_view changes = {});

}  // namespace realcam::shot
