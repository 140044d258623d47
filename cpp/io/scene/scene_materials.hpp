#pragma once
#include "../../scene/scene.hpp"
#include "file_scene.hpp"
#include "scene_textures.hpp"

namespace realcam::io {

/// Makes scene.materials of those of the file, number by number, with the textures that they need, and says what is not
/// modelled. `scale`: metres for a unit of the file.
void make_materials(Scene& scene, const FileScene& file, double scale, SceneTextures& textures);

}  // namespace realcam::io
