#pragma once
#include "../../scene/scene.hpp"
#include "scene_part.hpp"

namespace realcam::io {

/// Nodes flattened into scene.positions_m, normals, uvs and triangles. Material numbers are those of the file. Throws
/// SceneFileError where no triangle is left, unless `leaves_out` has had some.
void read_geometry(Scene& scene, const ScenePart& part, const LeavesOut& leaves_out);

}  // namespace realcam::io
