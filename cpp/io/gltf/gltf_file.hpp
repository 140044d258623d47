#pragma once
#include <string>

#include "../../checkpoint.hpp"
#include "../scene/file_scene.hpp"

namespace realcam::io {

/// Reads a glTF 2.0 file (.gltf or .glb). Nodes, skins and morph targets are animated by the file's animations;
/// skins and morph targets that they do not move are applied. `scene_name`: name or index of the scene; empty: the
/// file's own. Throws FileError, and SceneFileError that names the element.
FileScene read_gltf(const std::string& path, const std::string& scene_name, Checkpoint& checkpoint);

/// read_gltf for the bytes of a file. `path`: names them in messages; files are found beside it.
FileScene parse_gltf(const std::string& path, std::string bytes, const std::string& scene_name, Checkpoint& checkpoint);

}  // namespace realcam::io
