#pragma once
#include "../scene/file_scene.hpp"
#include "gltf_document.hpp"

namespace realcam::io {

/// Warns of the extensions that a file uses and that change nothing here, of each once.
void warn_of_extensions(FileScene& scene, const GltfDocument& document);

}  // namespace realcam::io
