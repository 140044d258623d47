#pragma once
#include <string>

#include "../../checkpoint.hpp"
#include "../scene/file_scene.hpp"

namespace realcam::io {

/// Reads a glTF 2.0, .gltf or .glb, in the pose that its nodes have: skins and morph targets are applied, cameras left
/// out. The nodes move as the first animation says. Throws FileError, and SceneFileError that names the element.
FileScene read_gltf(const std::string& path, Checkpoint& checkpoint);

}  // namespace realcam::io
