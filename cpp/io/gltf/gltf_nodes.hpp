#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "../../checkpoint.hpp"
#include "../../math/affine.hpp"
#include "../scene/file_scene.hpp"
#include "../text/json.hpp"
#include "gltf_accessors.hpp"

namespace realcam::io {

/// Returns a 4 x 4 matrix, stored by columns, as an affine map. `number(i)`: its element i.
template <class Number>
Affine<double> affine_of_columns(const Number& number) {
    const auto column = [&](std::size_t c) { return Vec3d{number(4 * c), number(4 * c + 1), number(4 * c + 2)}; };
    return {column(0), column(1), column(2), column(3)};
}

/// Returns the transform of a glTF node to its parent: from its matrix, or from translation, rotation and scale.
Affine<double> transform_of(const Json& node);

/// Returns a node's translation, rotation and scale as a motion without keys.
NodeMotion static_motion(const Json& node);

inline constexpr std::size_t kNoGltfNode = static_cast<std::size_t>(-1);

/// For each node of a FileScene, indices of nodes in the file. If a node has several instances of its mesh
/// (EXT_mesh_gpu_instancing), each of them becomes an additional child node, which does not exist in the file.
struct GltfNodeIndices {
    std::vector<std::size_t> nodes;  ///< the node itself; kNoGltfNode for an instance
    std::vector<std::size_t> meshes;  ///< the node whose mesh it has; kNoGltfNode if it has none
};

/// Sets scene.nodes to the nodes of a scene of the file, without their meshes; if the file has no scene, to all of its
/// nodes. `scene_name`: name or index of the scene; empty: the file's own, with a warning if there are others. Throws
/// SceneFileError if there is no such scene, or the nodes do not form trees or have too many instances.
GltfNodeIndices read_gltf_nodes(FileScene& scene, const GltfDocument& document, GltfAccessors& accessors,
                                const std::string& scene_name, Checkpoint& checkpoint);

/// Returns the transform from each node's frame to the scene, in units of the file; `nodes` are in depth-first order.
std::vector<Affine<double>> global_transforms(const std::vector<FileNode>& nodes);

}  // namespace realcam::io
