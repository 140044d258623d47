#pragma once
#include "../scene/scene.hpp"
#include "scene_import.hpp"
#include "scene_textures.hpp"

namespace realcam::io {

/// Phong exponent whose highlight is as wide as that of a GGX lobe of this glTF roughness, 0..1. At most 20000.
float phong_exponent(float roughness);

/// scene.materials becomes the list of the file, number by number, with the textures that it needs.
void read_materials(Scene& scene, const ImportedScene& file, SceneTextures& textures, const std::string& path);

}  // namespace realcam::io
