#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "../scene/file_scene.hpp"
#include "gltf_accessors.hpp"

namespace realcam::io {

/// For each joint of a skin, the map from the bind pose to the current pose, in the frame of the mesh's node.
using JointMaps = std::vector<Affine<double>>;

/// Skins of a file.
class GltfSkins {
public:
    /// `file_indices`: index in the file of each of scene.nodes, or kNoGltfNode. `document`, `accessors`
    /// and `checkpoint` must outlive the object.
    GltfSkins(const GltfDocument& document, GltfAccessors& accessors, const FileScene& scene,
              const std::vector<std::size_t>& file_indices, Checkpoint& checkpoint);

    /// Returns the joints of a skin. `skin`: index in the file. Throws SceneFileError.
    std::vector<FileJoint> joints(std::size_t skin) const;
    /// True if any joint moves in the frame of a node. `node`: index in scene.nodes.
    bool any_moves(const std::vector<FileJoint>& joints, std::uint32_t node) const;
    /// Returns the joint maps of joints that do not move in the frame of a node; std::nullopt if the transform of the
    /// node has no inverse. `node`: index in scene.nodes.
    std::optional<JointMaps> joint_maps(const std::vector<FileJoint>& joints, std::uint32_t node) const;

private:
    const GltfDocument& document_;
    GltfAccessors& accessors_;
    Checkpoint& checkpoint_;
    std::vector<Affine<double>> scene_from_node_;  ///< transforms of scene.nodes, without motion
    /// For each of scene.nodes, the nearest moving node among itself and its ancestors; kNoParent if there is none.
    std::vector<std::uint32_t> moved_by_;
    std::vector<std::uint32_t> node_index_;  ///< index in scene.nodes of each node of the file
};

/// Number of sets JOINTS_n and WEIGHTS_n that are read.
inline constexpr std::size_t kMaxJointSets = 4;

/// Reads the joint weights of a primitive; per_vertex is 0 if it has no joints. `attributes`: JSON of the primitive;
/// `vertices`, `joints`: numbers of these. Throws SceneFileError, whose message begins with `label`.
VertexJoints read_joint_weights(const GltfDocument& document, GltfAccessors& accessors, const Json& attributes,
                                std::size_t vertices, std::size_t joints, const std::string& label);

}  // namespace realcam::io
