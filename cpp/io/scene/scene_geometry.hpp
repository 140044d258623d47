#pragma once
#include "../../scene/scene.hpp"
#include "scene_part.hpp"

namespace realcam::io {

/// Adds the punctual lights of a glTF file, with intensities in cd and illuminances in lux; other formats have no
/// lights.
void read_lights(Scene& scene, const ScenePart& part, const LeavesOut& leaves_out);

/// Flattens nodes into scene.positions_m, normals, uvs and triangles. Material indices are those of the file. Throws
/// SceneFileError if no triangle is left, unless `leaves_out` left some out.
void read_geometry(Scene& scene, const ScenePart& part, const LeavesOut& leaves_out);

}  // namespace realcam::io
