#pragma once
#include "../scene/file_scene.hpp"
#include "gltf_document.hpp"

namespace realcam::io {

/// scene.materials become those of the file. scene.pictures have to be listed; one without bytes is added for textures
/// that name none. What is wrong in many places is one warning.
void read_gltf_materials(FileScene& scene, const GltfDocument& document);

}  // namespace realcam::io
