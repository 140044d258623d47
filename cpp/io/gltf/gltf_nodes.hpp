#pragma once
#include <cstddef>
#include <vector>

#include "../../checkpoint.hpp"
#include "../scene/file_scene.hpp"
#include "gltf_accessors.hpp"

namespace realcam::io {

inline constexpr std::size_t kNoGltfNode = static_cast<std::size_t>(-1);

/// The file's numbers of a scene's nodes. Where a node has many instances of its mesh (EXT_mesh_gpu_instancing), each
/// of them is a node more, below it, which the file does not have.
struct GltfNodeNumbers {
    std::vector<std::size_t> nodes;  ///< kNoGltfNode: it is an instance
    std::vector<std::size_t> meshes;  ///< the node whose mesh it has; kNoGltfNode: none
};

/// Fills scene.nodes with those of the file's scene, without their meshes. Without a scene in the file, with all that
/// are no other's child. Throws SceneFileError for nodes that form no tree.
GltfNodeNumbers lay_out_nodes(FileScene& scene, const GltfDocument& document, GltfAccessors& accessors,
                              Checkpoint& checkpoint);

/// The transforms of nodes in depth-first order, relative to the scene.
std::vector<Affine<double>> global_transforms(const std::vector<FileNode>& nodes);

}  // namespace realcam::io
