#pragma once
#include "../scene/file_scene.hpp"
#include "gltf_buffers.hpp"

namespace realcam::io {

/// scene.pictures become those of the file, those inside it without their bytes.
void list_pictures(FileScene& scene, const GltfDocument& document);

/// Fetches the bytes of the pictures that materials of scene.meshes use. Those that cannot be had stay empty.
void fetch_pictures(FileScene& scene, const GltfDocument& document, GltfBuffers& buffers);

}  // namespace realcam::io
