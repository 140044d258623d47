#pragma once
#include <string>

#include "../scene/scene.hpp"
#include "scene_import.hpp"

namespace realcam::io {

/// Nodes flattened into scene.positions_m, normals, uvs and triangles, `scale` metres per unit of the file. Material
/// numbers are those of the file. Throws SceneFileError, with `path`, if no triangle is left.
void read_geometry(Scene& scene, const ImportedScene& file, const std::string& path, double scale);

}  // namespace realcam::io
