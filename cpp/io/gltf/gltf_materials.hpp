#pragma once
#include "../scene/file_scene.hpp"
#include "gltf_document.hpp"

namespace realcam::io {

/// Sets scene.materials to the materials of the file. scene.pictures must have been listed; a picture without bytes is
/// added for textures that name none. Each kind of error gives one warning.
void read_gltf_materials(FileScene& scene, const GltfDocument& document);

}  // namespace realcam::io
