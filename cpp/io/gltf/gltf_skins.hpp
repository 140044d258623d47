#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "../scene/file_scene.hpp"
#include "gltf_accessors.hpp"

namespace realcam::io {

/// For each joint of a skin, the map from the bind pose to the current pose, in the frame of the mesh's node.
using JointMaps = std::vector<Affine<double>>;

/// Skins of a file in the pose of its nodes.
class GltfSkins {
public:
    /// `file_indices`: index in the file of each of scene.nodes, or kNoGltfNode. All arguments but `scene` and
    /// `file_indices` must outlive the object.
    GltfSkins(const GltfDocument& document, GltfAccessors& accessors, const FileScene& scene,
              const std::vector<std::size_t>& file_indices, Checkpoint& checkpoint);

    /// Returns the joint maps of a node with a skin; std::nullopt if its transform has no inverse. `skin`: index in the
    /// file; `node`: index in scene.nodes. Throws SceneFileError.
    std::optional<JointMaps> joint_maps(std::size_t skin, std::size_t node) const;

private:
    const GltfDocument& document_;
    GltfAccessors& accessors_;
    Checkpoint& checkpoint_;
    std::vector<Affine<double>> scene_from_node_;  ///< transforms of scene.nodes
    std::vector<std::uint32_t> node_index_;  ///< index in scene.nodes of each node of the file
};

/// Number of sets JOINTS_n and WEIGHTS_n that are read.
inline constexpr std::size_t kMaxJointSets = 4;

/// Joints that move each vertex, and their weights. They are stored as in the file: for each set of four joints per
/// vertex (JOINTS_0, JOINTS_1, ...), four numbers for each vertex.
struct JointWeights {
    std::size_t per_vertex = 0;  ///< number of joints of a vertex: 4 times the number of sets
    std::vector<std::uint32_t> joints;  ///< indices in JointMaps
    std::vector<float> weights;
};

/// Reads the joint weights of a primitive; per_vertex is 0 if it has no joints. `attributes`: JSON of the primitive;
/// `vertices`, `joints`: numbers of these. Throws SceneFileError, whose message begins with `label`.
JointWeights read_joint_weights(const GltfDocument& document, GltfAccessors& accessors, const Json& attributes,
                                std::size_t vertices, std::size_t joints, const std::string& label);

/// Transforms positions and normals by the weighted mean of the vertex's joint maps; weights need not sum to 1.
/// Vertices without weights remain as they are.
void apply_skin(FileVertices& vertices, const JointWeights& weights, const JointMaps& maps, Checkpoint& checkpoint);

}  // namespace realcam::io
