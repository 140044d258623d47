#pragma once
#include <string>

#include "../../checkpoint.hpp"
#include "../scene/file_scene.hpp"

namespace realcam::io {

/// Adds the materials of an MTL file to a scene, and the pictures that they name. Lines that cannot be read are counted
/// in one warning. Throws FileError, and SceneFileError with file and line for negative or infinite numbers.
void read_mtl(FileScene& scene, const std::string& path, Checkpoint& checkpoint);

}  // namespace realcam::io
