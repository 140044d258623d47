#pragma once
#include <cstddef>
#include <vector>

#include "../scene/file_scene.hpp"
#include "gltf_accessors.hpp"

namespace realcam::io {

/// Animates the nodes of a scene by the file's first animation; its channels that are not supported, and further
/// animations, are named in scene.warnings. `numbers`: index in the file of each node. Throws SceneFileError.
void read_gltf_animations(FileScene& scene, const GltfDocument& document, GltfAccessors& accessors,
                          const std::vector<std::size_t>& numbers, Checkpoint& checkpoint);

}  // namespace realcam::io
