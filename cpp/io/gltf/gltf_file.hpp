#pragma once
#include <string>

#include "../../checkpoint.hpp"
#include "../scene/file_scene.hpp"

namespace realcam::io {

/// Reads a glTF 2.0 file (.gltf or .glb) in the pose of its nodes: skins and morph targets are applied. Nodes are
/// animated by the first animation. Throws FileError, and SceneFileError that names the element.
FileScene read_gltf(const std::string& path, Checkpoint& checkpoint);

}  // namespace realcam::io
