#pragma once
#include <cstddef>
#include <map>
#include <memory>
#include <vector>

#include "../scene/file_scene.hpp"
#include "gltf_accessors.hpp"
#include "gltf_buffers.hpp"
#include "gltf_document.hpp"

namespace realcam::io {

// Readers of the parts of a glTF file, which read_gltf calls.

/// Keyframes of the weights of a node's morph targets.
struct GltfTargetKeys {
    std::shared_ptr<const VectorKeys> keys;  ///< null if there are none
    bool change = false;  ///< they are not constant
};
/// The same by the index of the node in the file.
using GltfTargetWeights = std::map<std::size_t, GltfTargetKeys>;

/// Animates the nodes of a scene by the file's animations together, and returns the weights of their morph targets. A
/// channel for a property that an earlier animation has a channel for is left out. Such channels and unsupported ones
/// give warnings. `file_indices`: index in the file of each of scene.nodes. Throws SceneFileError.
GltfTargetWeights read_gltf_animations(FileScene& scene, const GltfDocument& document, GltfAccessors& accessors,
                                       const std::vector<std::size_t>& file_indices, Checkpoint& checkpoint);

/// Sets scene.pictures to the images of the file; embedded ones are still without their bytes.
void list_pictures(FileScene& scene, const GltfDocument& document);

/// Fetches the bytes of the embedded pictures that materials of scene.meshes use. Pictures that cannot be read stay
/// empty.
void fetch_pictures(FileScene& scene, const GltfDocument& document, GltfBuffers& buffers);

/// Sets scene.materials to the materials of the file. Must be called after list_pictures; a picture without bytes is
/// added for textures that have no picture. Each kind of error gives one warning.
void read_gltf_materials(FileScene& scene, const GltfDocument& document);

/// Warns once of each extension that a file uses and that is not supported.
void warn_of_extensions(FileScene& scene, const GltfDocument& document);

/// Fills scene.cameras with the cameras that the file lists.
void read_gltf_cameras(FileScene& scene, const GltfDocument& document);

/// Sets scene.lights to the lights of KHR_lights_punctual.
void read_gltf_lights(FileScene& scene, const GltfDocument& document);

}  // namespace realcam::io
