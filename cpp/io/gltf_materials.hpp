#pragma once
#include "file_scene.hpp"
#include "gltf_buffers.hpp"

namespace realcam::io {

/// scene.materials and scene.pictures become those of the file, the pictures inside it without their bytes.
void read_gltf_materials(FileScene& scene, const GltfDocument& document);

/// Fetches the bytes of the pictures that materials of scene.meshes use. Those that cannot be had stay empty.
void fetch_pictures(FileScene& scene, const GltfDocument& document, GltfBuffers& buffers);

/// scene.lights become those of the file.
void read_gltf_lights(FileScene& scene, const GltfDocument& document);

}  // namespace realcam::io
