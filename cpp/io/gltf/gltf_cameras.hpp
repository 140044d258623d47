#pragma once
#include "../scene/file_scene.hpp"
#include "gltf_document.hpp"

namespace realcam::io {

/// Fills scene.cameras with the cameras that the file lists.
void read_gltf_cameras(FileScene& scene, const GltfDocument& document);

}  // namespace realcam::io
