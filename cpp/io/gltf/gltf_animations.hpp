#pragma once
#include <cstddef>
#include <vector>

#include "../scene/file_scene.hpp"
#include "gltf_accessors.hpp"

namespace realcam::io {

/// Lets the nodes of a scene move as the file's first animation says; what else it animates, and further animations,
/// are named in scene.warnings. `numbers`: the file's number of each node. Throws SceneFileError.
void read_gltf_animations(FileScene& scene, const GltfDocument& document, GltfAccessors& accessors,
                          const std::vector<std::size_t>& numbers, Checkpoint& checkpoint);

}  // namespace realcam::io
