#pragma once
#include <string>

#include "../../checkpoint.hpp"
#include "../scene/file_scene.hpp"

namespace realcam::io {

/// Reads a glTF 2.0 file (.gltf or .glb). Skins and morph targets are applied for the static pose of the nodes; nodes
/// are animated by the file's first animation. Throws FileError, and SceneFileError that names the element.
FileScene read_gltf(const std::string& path, Checkpoint& checkpoint);

/// read_gltf for the bytes of a file. `path`: names them in messages; files are found beside it.
FileScene parse_gltf(const std::string& path, std::string bytes, Checkpoint& checkpoint);

}  // namespace realcam::io
