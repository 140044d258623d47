#include "gltf_file.hpp"

#include <optional>
#include <utility>

#include "../../error.hpp"
#include "../files/regular_file.hpp"
#include "gltf_meshes.hpp"
#include "gltf_nodes.hpp"
#include "gltf_readers.hpp"

namespace realcam::io {
namespace {

/// Checks the memory for meshes that nodes deform individually: a file of a megabyte may have twenty thousand of them.
void check_deformed_meshes(const FileScene& scene, const GltfDocument& document, GltfMeshes& meshes,
                           const GltfNodeIndices& file_indices) {
    double bytes = 0;
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const Json& node = document.root()["nodes"][file_indices.meshes[i]];
        const std::size_t count = document.root()["meshes"].size(), mesh = node["mesh"].index(count);
        const bool is_skinned = !node["skin"].is_null();
        if (mesh < count && (is_skinned || !node["weights"].is_null()))
            bytes += meshes.deformed_bytes(mesh, is_skinned);
    }
    meshes.check_deformed_bytes(bytes);
}

/// Adds the meshes of all nodes. Skins of nodes whose transform has no inverse are left out, with a warning.
void add_meshes(FileScene& scene, const GltfDocument& document, GltfBuffers& buffers, GltfAccessors& accessors,
                const GltfNodeIndices& file_indices, Checkpoint& checkpoint) {
    const GltfSkins skins(document, accessors, scene, file_indices.nodes, checkpoint);
    GltfMeshes meshes(document, buffers, accessors, scene, checkpoint);
    check_deformed_meshes(scene, document, meshes, file_indices);
    std::size_t left_out = 0;  // number of skins
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        if (file_indices.meshes[i] == kNoGltfNode) continue;
        const Json& node = document.root()["nodes"][file_indices.meshes[i]];
        const std::string label = gltf_label("node", file_indices.meshes[i], node);
        const std::optional<std::size_t> mesh = document.find("meshes", node["mesh"], label + ": its mesh");
        if (!mesh) continue;
        std::optional<JointMaps> joints;
        // Instances have no skin: the extension does not define how it would deform them.
        const bool is_instance = file_indices.nodes[i] == kNoGltfNode;
        const auto skin = is_instance ? std::nullopt : document.find("skins", node["skin"], label + ": its skin");
        if (skin) {
            joints = skins.joint_maps(*skin, i);
            if (!joints) ++left_out;
        }
        const GltfMeshes::Range range = meshes.add(*mesh, node["weights"], joints);
        scene.nodes[i].first_mesh = range.first;
        scene.nodes[i].mesh_count = range.count;
    }
    if (left_out > 0)
        scene.warnings.push_back(std::to_string(left_out) + " skins are left out: their nodes are scaled to zero");
}

}  // namespace

FileScene read_gltf(const std::string& path, Checkpoint& checkpoint) {
    return parse_gltf(path, read_whole_file(path, checkpoint), checkpoint);
}

FileScene parse_gltf(const std::string& path, std::string bytes, Checkpoint& checkpoint) {
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
    const GltfNodeIndices file_indices = read_gltf_nodes(scene, document, accessors, checkpoint);
    add_meshes(scene, document, buffers, accessors, file_indices, checkpoint);
    read_gltf_animations(scene, document, accessors, file_indices.nodes, checkpoint);
    fetch_pictures(scene, document, buffers);
    return scene;
}

}  // namespace realcam::io
