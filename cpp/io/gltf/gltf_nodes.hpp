#pragma once
#include <cstddef>
#include <vector>

#include "../../checkpoint.hpp"
#include "../../math/affine.hpp"
#include "../scene/file_motion.hpp"
#include "../scene/file_scene.hpp"
#include "../text/json.hpp"
#include "gltf_accessors.hpp"

namespace realcam::io {

/// Returns the transform of a glTF node to its parent: from its matrix, or from translation, rotation and scale.
Affine<double> transform_of(const Json& node);

/// Returns a node's translation, rotation and scale as a motion without keys.
FileMotion standing(const Json& node);

inline constexpr std::size_t kNoGltfNode = static_cast<std::size_t>(-1);

/// Indices in the file of a scene's nodes. If a node has several instances of its mesh (EXT_mesh_gpu_instancing), each
/// of them is an additional node below it that does not exist in the file.
struct GltfNodeNumbers {
    std::vector<std::size_t> nodes;  ///< kNoGltfNode for an instance
    std::vector<std::size_t> meshes;  ///< the node in the file whose mesh it has, or kNoGltfNode
};

/// Fills scene.nodes with the nodes of the file's scene, without their meshes; if the file has no scene, with all trees
/// of nodes. Throws SceneFileError if the nodes are not trees.
GltfNodeNumbers lay_out_nodes(FileScene& scene, const GltfDocument& document, GltfAccessors& accessors,
                              Checkpoint& checkpoint);

/// Returns the transforms from node frames to the scene; `nodes` are in depth-first order.
std::vector<Affine<double>> global_transforms(const std::vector<FileNode>& nodes);

}  // namespace realcam::io
