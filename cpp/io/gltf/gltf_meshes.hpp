#pragma once
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "../scene/file_scene.hpp"
#include "gltf_skins.hpp"

namespace realcam::io {

/// Adds the meshes of a glTF to a scene: one FileMesh per primitive. Vertices that primitives share are added once.
class GltfMeshes {
public:
    /// All arguments have to outlive the object. scene.materials must be those of the file.
    GltfMeshes(const GltfDocument& document, GltfAccessors& accessors, FileScene& scene, Checkpoint& checkpoint)
        : document_(document), accessors_(accessors), scene_(scene), checkpoint_(checkpoint) {}

    struct Range {
        std::uint32_t first, count;  ///< in scene.meshes
    };

    /// Adds a mesh. `weights`: morph target weights of the node, or null for those of the mesh. `joints`: joint
    /// transforms, if the node has a skin. A mesh without either is added only once. Throws SceneFileError.
    Range add(std::size_t mesh, const Json& weights, const std::optional<JointMaps>& joints);

    /// Returns the number of bytes, according to the file, of the copy of a mesh for a node with a skin or with its own
    /// weights.
    double bytes_of_own(std::size_t mesh, bool is_skinned);
    /// Throws SceneFileError if such copies need more memory than is free.
    void check_promise(double bytes) const;

private:
    struct Primitive {
        const Json& json;
        const Json& weights;
        const std::optional<JointMaps>& joints;
        std::string label;
        std::uint32_t material;
    };

    void add_primitive(const Primitive& primitive);
    void check_compression(const Primitive& primitive) const;
    std::uint32_t material_of(const Json& primitive, const std::string& label);
    std::uint32_t vertices_of(const Primitive& primitive);
    FileVertices read_vertices(const Primitive& primitive, const Json& uvs, const Json& second_uvs);
    std::vector<VertexColor> read_colours(const Json& reference, const std::string& where);
    void add_targets(const Primitive& primitive, FileVertices& vertices);
    std::vector<Triangle> read_triangles(const Primitive& primitive, std::size_t vertices);
    std::vector<std::uint32_t> read_indices(const Primitive& primitive, std::size_t vertices);
    void check_memory(const FileMesh& mesh);
    void check_count(std::size_t count, std::size_t vertices, const std::string& where) const;

    /// Indices of the accessors of positions, normals, both sets of texture coordinates, and colours.
    using Attributes = std::tuple<std::size_t, std::size_t, std::size_t, std::size_t, std::size_t>;

    const GltfDocument& document_;
    GltfAccessors& accessors_;
    FileScene& scene_;
    Checkpoint& checkpoint_;
    std::map<std::size_t, Range> added_;
    std::map<std::pair<std::size_t, bool>, double> own_bytes_;
    std::map<Attributes, std::uint32_t> shared_vertices_;
    std::optional<std::uint32_t> default_material_;
    std::size_t bytes_ = 0, next_check_ = std::size_t{1} << 28;  // size of the meshes added so far
};

}  // namespace realcam::io
