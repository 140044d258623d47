#include "gltf_file.hpp"

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "../../error.hpp"
#include "../files/regular_file.hpp"
#include "gltf_meshes.hpp"
#include "gltf_nodes.hpp"
#include "gltf_readers.hpp"

namespace realcam::io {
namespace {

/// Adds the meshes of all nodes to a scene.
class MeshAdder {
public:
    MeshAdder(FileScene& scene, const GltfDocument& document, GltfBuffers& buffers, GltfAccessors& accessors,
              const GltfNodeIndices& file_indices, const GltfTargetWeights& target_weights, Checkpoint& checkpoint)
        : scene_(scene),
          document_(document),
          file_indices_(file_indices),
          target_weights_(target_weights),
          skins_(document, accessors, scene, file_indices.nodes, checkpoint),
          meshes_(document, buffers, accessors, scene, checkpoint) {}

    /// Skins of nodes whose transform has no inverse are left out, with a warning.
    void add() {
        check_memory();
        for (std::uint32_t i = 0; i < scene_.nodes.size(); ++i) {
            if (file_indices_.meshes[i] == kNoGltfNode) continue;
            const std::string where = gltf_label("node", file_indices_.meshes[i], json_of(i)) + ": its mesh";
            if (const auto mesh = document_.find("meshes", json_of(i)["mesh"], where)) add_mesh(i, *mesh);
        }
        if (left_out_ > 0)
            scene_.warnings.push_back(std::to_string(left_out_) +
                                      " skins are left out: their nodes are scaled to zero");
        if (!scene_.deformations.empty())
            scene_.warnings.push_back(std::to_string(scene_.deformations.size()) +
                                      " meshes change their shape over time; a picture shows them as they are in the "
                                      "middle of the exposure, without blur by that change");
    }

private:
    /// Returns the node of the file whose mesh a node of the scene has. `node`: index in scene_.nodes.
    const Json& json_of(std::uint32_t node) const { return document_.root()["nodes"][file_indices_.meshes[node]]; }

    GltfTargetKeys target_keys(std::uint32_t node) const {
        const auto found = target_weights_.find(file_indices_.meshes[node]);
        return found == target_weights_.end() ? GltfTargetKeys{} : found->second;
    }

    /// Checks the memory for meshes that nodes deform individually: a file of a megabyte may have twenty thousand.
    void check_memory() {
        double bytes = 0;
        const std::size_t count = document_.root()["meshes"].size();
        for (std::uint32_t i = 0; i < scene_.nodes.size(); ++i) {
            const Json& node = json_of(i);
            const std::size_t mesh = node["mesh"].index(count);
            const bool is_skinned = !node["skin"].is_null();
            const GltfTargetKeys weights = target_keys(i);
            if (mesh < count && (is_skinned || weights.keys || !node["weights"].is_null()))
                bytes += meshes_.deformed_bytes(mesh, is_skinned, weights.change);
        }
        meshes_.check_deformed_bytes(bytes);
    }

    void add_mesh(std::uint32_t node, std::size_t mesh) {
        FileDeformation deformation;
        GltfShape shape;
        if (const auto& [keys, change] = target_keys(node); keys) {
            shape.target_weights.resize(keys->components);
            keys->at(0, shape.target_weights.data());
            if (change) deformation.target_weights = keys;
        } else {
            shape.target_weights = target_weights_of(json_of(node)["weights"]);
        }
        if (deformation.target_weights) shape.moving_targets = shape.target_weights.size();
        add_skin(node, shape, deformation);
        const GltfMeshes::Range range = meshes_.add(mesh, shape);
        scene_.nodes[node].first_mesh = range.first;
        scene_.nodes[node].mesh_count = range.count;
        if (!shape.moves()) return;
        scene_.nodes[node].deformation = static_cast<std::int32_t>(scene_.deformations.size());
        scene_.deformations.push_back(std::move(deformation));
    }

    void add_skin(std::uint32_t node, GltfShape& shape, FileDeformation& deformation) {
        // Instances have no skin: the extension does not define how it would deform them.
        if (file_indices_.nodes[node] == kNoGltfNode) return;
        const std::string where = gltf_label("node", file_indices_.meshes[node], json_of(node)) + ": its skin";
        const auto skin = document_.find("skins", json_of(node)["skin"], where);
        if (!skin) return;
        std::vector<FileJoint> joints = skins_.joints(*skin);
        if (shape.moves() || skins_.any_moves(joints, node)) {
            shape.moving_joints = joints.size();
            deformation.joints = std::move(joints);
        } else {
            shape.joints = skins_.joint_maps(joints, node);
            if (!shape.joints) ++left_out_;
        }
    }

    FileScene& scene_;
    const GltfDocument& document_;
    const GltfNodeIndices& file_indices_;
    const GltfTargetWeights& target_weights_;
    GltfSkins skins_;
    GltfMeshes meshes_;
    std::size_t left_out_ = 0;  ///< number of skins
};

}  // namespace

FileScene read_gltf(const std::string& path, const std::string& scene_name, Checkpoint& checkpoint) {
    return parse_gltf(path, read_whole_file(path, checkpoint), scene_name, checkpoint);
}

FileScene parse_gltf(const std::string& path, std::string bytes, const std::string& scene_name,
                     Checkpoint& checkpoint) {
    const GltfDocument document(path, std::move(bytes), checkpoint);
    GltfBuffers buffers(document, checkpoint);
    GltfAccessors accessors(document, buffers, checkpoint);
    FileScene scene;
    scene.path = path;
    read_gltf_lights(scene, document);
    read_gltf_cameras(scene, document);
    list_pictures(scene, document);
    read_gltf_materials(scene, document);
    warn_of_extensions(scene, document);
    const GltfNodeIndices file_indices = read_gltf_nodes(scene, document, accessors, scene_name, checkpoint);
    const GltfTargetWeights target_weights =
        read_gltf_animations(scene, document, accessors, file_indices.nodes, checkpoint);
    MeshAdder(scene, document, buffers, accessors, file_indices, target_weights, checkpoint).add();
    fetch_pictures(scene, document, buffers);
    return scene;
}

}  // namespace realcam::io
