#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "../scene/file_scene.hpp"
#include "gltf_accessors.hpp"

namespace realcam::io {

/// For each joint of a skin the map from where the mesh was bound to where it is now, in the mesh's node.
using JointMaps = std::vector<Affine<double>>;

/// The skins of a file in the pose of its nodes.
class GltfSkins {
public:
    /// `numbers`: the file's number of each of scene.nodes; what is no number of a node has none. All arguments have to
    /// outlive it.
    GltfSkins(const GltfDocument& document, GltfAccessors& accessors, const FileScene& scene,
              const std::vector<std::size_t>& numbers, Checkpoint& checkpoint);

    /// The joint maps of a node with a skin; nothing where its transform has no inverse. Throws SceneFileError.
    std::optional<JointMaps> joint_maps(std::size_t skin, std::size_t node) const;

private:
    const GltfDocument& document_;
    GltfAccessors& accessors_;
    Checkpoint& checkpoint_;
    std::vector<Affine<double>> globals_;
    std::vector<std::uint32_t> place_of_;  // of the file's nodes in scene.nodes
};

/// Which joints move a vertex, and how much: `per_vertex` of them for each.
struct JointWeights {
    std::size_t per_vertex = 0;
    std::vector<std::uint32_t> joints;
    std::vector<float> weights;
};

/// The joint weights of a primitive; per_vertex is 0 where it has none. Throws SceneFileError, which begins with
/// `label`.
JointWeights read_joint_weights(const GltfDocument& document, GltfAccessors& accessors, const Json& attributes,
                                std::size_t vertices, std::size_t joints, const std::string& label);

void apply_skin(FileVertices& vertices, const JointWeights& weights, const JointMaps& maps, Checkpoint& checkpoint);

}  // namespace realcam::io
