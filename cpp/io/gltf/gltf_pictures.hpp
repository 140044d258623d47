#pragma once
#include "../scene/file_scene.hpp"
#include "gltf_buffers.hpp"

namespace realcam::io {

/// Sets scene.pictures to the images of the file; embedded ones are still without their bytes.
void list_pictures(FileScene& scene, const GltfDocument& document);

/// Fetches the bytes of the embedded pictures that materials of scene.meshes use. Pictures that cannot be read stay
/// empty.
void fetch_pictures(FileScene& scene, const GltfDocument& document, GltfBuffers& buffers);

}  // namespace realcam::io
