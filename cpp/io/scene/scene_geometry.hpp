#pragma once
#include "../../scene/scene.hpp"
#include "scene_part.hpp"

namespace realcam::io {

/// Flattens nodes into scene.positions_m, normals, uvs and triangles. Material indices are those of the file. Throws
/// SceneFileError if no triangle is left, unless `leaves_out` left some out.
void read_geometry(Scene& scene, const ScenePart& part, const LeavesOut& leaves_out);

}  // namespace realcam::io
