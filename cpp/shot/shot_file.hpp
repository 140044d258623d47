#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "shot_keys.hpp"

namespace realcam::shot {

/// True if the path is that of a shot file (.toml), false for a scene file.
bool is_shot_file(const std::string& path);

/// Values that replace those of a shot file. They also remove the values that they exclude (ShotKey::replaces), in the
/// file's tables [[key]] too. Their paths are relative to the current folder.
struct ShotChanges {
    std::string toml;  ///< keys with their values, as TOML
    std::vector<std::pair<const ShotKey*, std::string>>
        options;  ///< options of the command line, with the texts of their values
};

/// Reads the request of a shot file (format 1, described in docs/shot-files.md), whose paths are relative to it, or of
/// a scene file alone. Throws InputError that names file, line and key.
ShotRequest read_shot(const std::string& path, const ShotChanges& changes = {});

/// Request for a scene without a shot file. `path`: the scene file.
ShotRequest shot_of_scene(const std::string& path, const ShotChanges& changes = {});

/// Parses the text of a shot file. `path`: its name in messages, and the file to which its paths are relative.
ShotRequest parse_shot(std::string_view text, const std::string& path, const ShotChanges& changes = {});

}  // namespace realcam::shot
