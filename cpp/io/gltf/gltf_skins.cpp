#include "gltf_skins.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "gltf_nodes.hpp"

namespace realcam::io {
namespace {

Affine<double> affine_of(const InverseAffine<double>& inverse) {
    return {inverse.x, inverse.y, inverse.z, inverse.direction(-inverse.origin)};
}

}  // namespace

GltfSkins::GltfSkins(const GltfDocument& document, GltfAccessors& accessors, const FileScene& scene,
                     const std::vector<std::size_t>& file_indices, Checkpoint& checkpoint)
    : document_(document),
      accessors_(accessors),
      checkpoint_(checkpoint),
      node_index_(document.root()["nodes"].size(), kNoParent) {
    if (document.root()["skins"].size() == 0) return;
    scene_from_node_ = global_transforms(scene.nodes);
    for (std::uint32_t i = 0; i < scene.nodes.size(); ++i) {
        const FileNode& node = scene.nodes[i];
        moved_by_.push_back(node.motion >= 0 ? i : node.parent == kNoParent ? kNoParent : moved_by_[node.parent]);
    }
    for (std::uint32_t i = 0; i < file_indices.size(); ++i)
        if (file_indices[i] < node_index_.size()) node_index_[file_indices[i]] = i;
}

std::vector<FileJoint> GltfSkins::joints(std::size_t index) const {
    const std::string label = "skin " + std::to_string(index);
    const Json& skin = document_.root()["skins"][index];
    const std::size_t count = skin["joints"].size();
    if (count == 0) document_.fail(label + ": has no joints");
    std::vector<float> inverse_binds;
    if (!skin["inverseBindMatrices"].is_null()) {
        inverse_binds = accessors_.numbers(skin["inverseBindMatrices"], "MAT4", label);
        if (inverse_binds.size() < 16 * count) document_.fail(label + ": has fewer inverseBindMatrices than joints");
    }
    std::vector<FileJoint> joints;
    for (std::size_t j = 0; j < count; ++j) {
        checkpoint_.pass();
        const std::optional<std::size_t> joint = document_.find("nodes", skin["joints"][j], label);
        if (!joint || node_index_[*joint] == kNoParent) document_.fail(label + ": a joint is not a node of the scene");
        joints.push_back(
            {node_index_[*joint], inverse_binds.empty() ? Affine<double>() : affine_of_columns([&](std::size_t i) {
                 return double(inverse_binds[16 * j + i]);
             })});
    }
    return joints;
}

bool GltfSkins::any_moves(const std::vector<FileJoint>& joints, std::uint32_t node) const {
    return std::any_of(joints.begin(), joints.end(),
                       [&](const FileJoint& joint) { return moved_by_[joint.node] != moved_by_[node]; });
}

std::optional<JointMaps> GltfSkins::joint_maps(const std::vector<FileJoint>& joints, std::uint32_t node) const {
    const double volume = scene_from_node_[node].determinant();
    if (volume == 0 || !std::isfinite(1 / volume)) return std::nullopt;
    const Affine<double> node_from_scene = affine_of(scene_from_node_[node].inverse());
    JointMaps maps;
    for (const FileJoint& joint : joints)
        maps.push_back(node_from_scene * scene_from_node_[joint.node] * joint.node_from_rest);
    return maps;
}

VertexJoints read_joint_weights(const GltfDocument& document, GltfAccessors& accessors, const Json& attributes,
                                std::size_t vertices, std::size_t joints, const std::string& label) {
    std::vector<std::vector<std::uint32_t>> joint_sets;
    std::vector<std::vector<float>> weight_sets;
    for (std::size_t set = 0; set < kMaxJointSets; ++set) {
        const std::string suffix = '_' + std::to_string(set);
        const Json &joint_json = attributes["JOINTS" + suffix], &weight_json = attributes["WEIGHTS" + suffix];
        if (joint_json.is_null() || weight_json.is_null()) break;
        std::vector<std::uint32_t> indices = accessors.integers(joint_json, "VEC4", label + ": JOINTS" + suffix);
        std::vector<float> weights = accessors.numbers(weight_json, "VEC4", label + ": WEIGHTS" + suffix);
        if (indices.size() != 4 * vertices || weights.size() != 4 * vertices)
            document.fail(label + ": JOINTS" + suffix + " and WEIGHTS" + suffix +
                          " must have one element for each of " + std::to_string(vertices) + " vertices");
        for (std::size_t i = 0; i < indices.size(); ++i) {
            if (weights[i] == 0) indices[i] = 0;
            if (indices[i] >= joints)
                document.fail(label + ": joint " + std::to_string(indices[i]) +
                              " is not smaller than the number of joints, " + std::to_string(joints));
        }
        joint_sets.push_back(std::move(indices));
        weight_sets.push_back(std::move(weights));
    }
    VertexJoints out;
    out.per_vertex = static_cast<std::uint32_t>(4 * joint_sets.size());
    for (std::size_t v = 0; v < vertices && !joint_sets.empty(); ++v)
        for (std::size_t set = 0; set < joint_sets.size(); ++set) {
            const auto first = static_cast<std::ptrdiff_t>(4 * v);
            out.joints.insert(out.joints.end(), joint_sets[set].begin() + first, joint_sets[set].begin() + first + 4);
            out.weights.insert(out.weights.end(), weight_sets[set].begin() + first,
                               weight_sets[set].begin() + first + 4);
        }
    return out;
}

}  // namespace realcam::io
