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
    /// `numbers`: index in the file of each of scene.nodes, or kNoGltfNode. All arguments have to outlive the object.
    GltfSkins(const GltfDocument& document, GltfAccessors& accessors, const FileScene& scene,
              const std::vector<std::size_t>& numbers, Checkpoint& checkpoint);

    /// Returns the joint maps of a node with a skin; std::nullopt if its transform has no inverse. Throws
    /// SceneFileError.
    std::optional<JointMaps> joint_maps(std::size_t skin, std::size_t node) const;

private:
    const GltfDocument& document_;
    GltfAccessors& accessors_;
    Checkpoint& checkpoint_;
    std::vector<Affine<double>> globals_;
    std::vector<std::uint32_t> node_index_;  // index in scene.nodes of each node of the file
};

/// Joints of each vertex and their weights, `per_vertex` of them for each.
struct JointWeights {
    std::size_t per_vertex = 0;
    std::vector<std::uint32_t> joints;
    std::vector<float> weights;
};

/// Reads the joint weights of a primitive; per_vertex is 0 if it has no joints. Throws SceneFileError, which begins
/// with `label`.
JointWeights read_joint_weights(const GltfDocument& document, GltfAccessors& accessors, const Json& attributes,
                                std::size_t vertices, std::size_t joints, const std::string& label);

void apply_skin(FileVertices& vertices, const JointWeights& weights, const JointMaps& maps, Checkpoint& checkpoint);

}  // namespace realcam::io
