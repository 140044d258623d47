#pragma once
#include "../scene/scene.hpp"
#include "file_scene.hpp"
#include "scene_textures.hpp"

namespace realcam::io {

/// Phong exponent whose highlight is as wide as that of a GGX lobe of this glTF roughness, 0..1. At most 20000.
float phong_exponent(float roughness);

/// Makes scene.materials of those of the file, number by number, with the textures that they need: a diffuse and a
/// Phong lobe each.
void make_materials(Scene& scene, const FileScene& file, SceneTextures& textures);

}  // namespace realcam::io
