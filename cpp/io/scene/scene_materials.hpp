#pragma once
#include "../../scene/scene.hpp"
#include "file_scene.hpp"
#include "scene_textures.hpp"

namespace realcam::io {

/// Makes scene.materials from the materials of the file, with the same indices, and the textures that they need; warns
/// of properties that are not modelled. `scale`: metres per unit of the file.
void make_materials(Scene& scene, const FileScene& file, double scale, SceneTextures& textures);

}  // namespace realcam::io
