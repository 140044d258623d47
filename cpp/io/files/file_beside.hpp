#pragma once
#include <optional>
#include <string>

namespace realcam::io {

/// The regular file that a scene file means by a name. Files from other machines spell names with backslashes, and by
/// paths that exist only there; what is meant then mostly lies beside the scene. Nothing where there is no such file.
std::optional<std::string> find_beside(const std::string& scene_path, const std::string& name);

}  // namespace realcam::io
