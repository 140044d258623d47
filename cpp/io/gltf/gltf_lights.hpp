#pragma once
#include "../scene/file_scene.hpp"
#include "gltf_document.hpp"

namespace realcam::io {

/// Sets scene.lights to the lights of KHR_lights_punctual.
void read_gltf_lights(FileScene& scene, const GltfDocument& document);

}  // namespace realcam::io
