#pragma once
#include "../scene/file_scene.hpp"
#include "gltf_document.hpp"

namespace realcam::io {

/// Warns once of each extension that a file uses and that is not supported.
void warn_of_extensions(FileScene& scene, const GltfDocument& document);

}  // namespace realcam::io
