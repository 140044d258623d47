#pragma once
#include <optional>
#include <string>

namespace realcam::io {

/// Returns the path of the regular file that a scene file refers to by a name. Files from other machines have names
/// with backslashes and paths that exist only there; then a file of that name beside the scene is taken. Returns
/// std::nullopt if there is no such file.
std::optional<std::string> find_beside(const std::string& scene_path, const std::string& name);

}  // namespace realcam::io
