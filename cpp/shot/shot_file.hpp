#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "shot_keys.hpp"

namespace realcam::shot {

/// True for a shot file, false for a scene file.
bool is_shot_file(const std::string& path);

/// Values that take the place of those of a shot file, and of those that they exclude, also in its tables [[key]].
/// Their paths are relative to the current folder.
struct ShotChanges {
    std::string toml;  ///< keys with their values
    std::vector<std::pair<const ShotKey*, std::string>> options;  ///< of the command line, with their words
};

/// The request of a shot file (format 1, described in docs/shot-files.md), whose paths are relative to it, or of a
/// scene file alone. Throws InputError that names file, line and key.
ShotRequest read_shot(const std::string& path, const ShotChanges& changes = {});

/// The request of a scene that has no shot file. `path`: as of read_shot.
ShotRequest shot_of_scene(const std::string& path, const ShotChanges& changes = {});

/// The same from the text of a shot file. `path` is what messages call it, and what its paths are relative to.
ShotRequest parse_shot(std::string_view text, const std::string& path, const ShotChanges& changes = {});

}  // namespace realcam::shot
