#include "gltf_skins.hpp"

#include <cmath>
#include <string>

#include "gltf_nodes.hpp"

namespace realcam::io {
namespace {

/// Returns a 4 x 4 matrix, stored by columns, as an affine map.
Affine<double> affine_of(const float* m) {
    const auto column = [&](int c) { return Vec3d{double(m[4 * c]), double(m[4 * c + 1]), double(m[4 * c + 2])}; };
    return {column(0), column(1), column(2), column(3)};
}

Affine<double> affine_of(const InverseAffine<double>& inverse) {
    return {inverse.x, inverse.y, inverse.z, inverse.direction(-inverse.origin)};
}

/// Adds weight * map, entry by entry.
void add(Affine<double>& sum, double weight, const Affine<double>& map) {
    sum.x += weight * map.x;
    sum.y += weight * map.y;
    sum.z += weight * map.z;
    sum.origin += weight * map.origin;
}

constexpr Affine<double> kZero = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};

}  // namespace

GltfSkins::GltfSkins(const GltfDocument& document, GltfAccessors& accessors, const FileScene& scene,
                     const std::vector<std::size_t>& file_indices, Checkpoint& checkpoint)
    : document_(document),
      accessors_(accessors),
      checkpoint_(checkpoint),
      node_index_(document.root()["nodes"].size(), kNoParent) {
    if (document.root()["skins"].size() == 0) return;
    scene_from_node_ = global_transforms(scene.nodes);
    for (std::uint32_t i = 0; i < file_indices.size(); ++i)
        if (file_indices[i] < node_index_.size()) node_index_[file_indices[i]] = i;
}

std::optional<JointMaps> GltfSkins::joint_maps(std::size_t index, std::size_t node) const {
    const std::string label = "skin " + std::to_string(index);
    const Json& skin = document_.root()["skins"][index];
    const std::size_t count = skin["joints"].size();
    if (count == 0) document_.fail(label + ": has no joints");
    std::vector<float> inverse_binds;
    if (!skin["inverseBindMatrices"].is_null()) {
        inverse_binds = accessors_.numbers(skin["inverseBindMatrices"], "MAT4", label);
        if (inverse_binds.size() < 16 * count) document_.fail(label + ": has fewer inverseBindMatrices than joints");
    }
    const double volume = scene_from_node_[node].determinant();
    if (volume == 0 || !std::isfinite(1 / volume)) return std::nullopt;
    const Affine<double> node_from_scene = affine_of(scene_from_node_[node].inverse());
    JointMaps maps;
    for (std::size_t j = 0; j < count; ++j) {
        checkpoint_.pass();
        const std::optional<std::size_t> joint = document_.find("nodes", skin["joints"][j], label);
        if (!joint || node_index_[*joint] == kNoParent) document_.fail(label + ": a joint is not a node of the scene");
        const Affine<double> node_from_joint = node_from_scene * scene_from_node_[node_index_[*joint]];
        maps.push_back(inverse_binds.empty() ? node_from_joint : node_from_joint * affine_of(&inverse_binds[16 * j]));
    }
    return maps;
}

JointWeights read_joint_weights(const GltfDocument& document, GltfAccessors& accessors, const Json& attributes,
                                std::size_t vertices, std::size_t joints, const std::string& label) {
    JointWeights out;
    for (std::size_t set = 0; set < kMaxJointSets; ++set) {
        const std::string suffix = '_' + std::to_string(set);
        const Json &joint_json = attributes["JOINTS" + suffix], &weight_json = attributes["WEIGHTS" + suffix];
        if (joint_json.is_null() || weight_json.is_null()) break;
        const std::vector<std::uint32_t> indices = accessors.integers(joint_json, "VEC4", label + ": JOINTS" + suffix);
        const std::vector<float> weights = accessors.numbers(weight_json, "VEC4", label + ": WEIGHTS" + suffix);
        if (indices.size() != 4 * vertices || weights.size() != 4 * vertices)
            document.fail(label + ": JOINTS" + suffix + " and WEIGHTS" + suffix +
                          " must have one element for each of " + std::to_string(vertices) + " vertices");
        for (std::size_t i = 0; i < indices.size(); ++i)
            if (weights[i] != 0 && indices[i] >= joints)
                document.fail(label + ": joint " + std::to_string(indices[i]) +
                              " is not smaller than the number of joints, " + std::to_string(joints));
        // The layout of JointWeights.
        out.joints.insert(out.joints.end(), indices.begin(), indices.end());
        out.weights.insert(out.weights.end(), weights.begin(), weights.end());
        out.per_vertex += 4;
    }
    return out;
}

void apply_skin(FileVertices& vertices, const JointWeights& weights, const JointMaps& maps, Checkpoint& checkpoint) {
    const std::size_t count = vertices.positions.size();
    for (std::size_t v = 0; v < count; ++v) {
        checkpoint.pass();
        Affine<double> map = kZero;
        double sum = 0;
        for (std::size_t k = 0; k < weights.per_vertex; ++k) {
            const std::size_t i = 4 * (count * (k / 4) + v) + k % 4;  // see JointWeights
            const auto weight = static_cast<double>(weights.weights[i]);
            if (weight == 0) continue;
            add(map, weight, maps[weights.joints[i]]);
            sum += weight;
        }
        if (sum == 0) continue;  // no joint moves it
        Affine<double> mean = kZero;
        add(mean, 1 / sum, map);
        vertices.positions[v] = mean.point(vertices.positions[v]);
        if (!vertices.normals.empty())
            vertices.normals[v] = static_cast<Vec3f>(mean.normal(static_cast<Vec3d>(vertices.normals[v])));
    }
}

}  // namespace realcam::io
