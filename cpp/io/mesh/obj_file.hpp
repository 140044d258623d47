#pragma once
#include <string>

#include "../../checkpoint.hpp"
#include "../scene/file_scene.hpp"

namespace realcam::io {

/// Reads an OBJ file and the MTL files that it names. Each name after "o" or "g" becomes a node, with the faces that
/// follow it; polygons are triangulated. `scale`: metres per unit, for the limit on coordinates (in_reach). Throws
/// FileError, and SceneFileError with the line.
FileScene read_obj(const std::string& path, double scale, Checkpoint& checkpoint);

}  // namespace realcam::io
