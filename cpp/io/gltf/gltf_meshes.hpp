#pragma once
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "../scene/file_scene.hpp"
#include "gltf_compression.hpp"
#include "gltf_skins.hpp"

namespace realcam::io {

/// Adds the meshes of a glTF to a scene: one FileMesh per primitive. Vertices that primitives share are added once.
class GltfMeshes {
public:
    /// All arguments must outlive the object. scene.materials must be those of the file.
    GltfMeshes(const GltfDocument& document, GltfBuffers& buffers, GltfAccessors& accessors, FileScene& scene,
               Checkpoint& checkpoint)
        : document_(document), buffers_(buffers), accessors_(accessors), scene_(scene), checkpoint_(checkpoint) {}

    /// Range of scene.meshes.
    struct Range {
        std::uint32_t first, count;
    };

    /// Adds a mesh and returns its primitives. `mesh`: index in the file; `weights`: JSON array of the node's morph
    /// target weights, or null for those of the mesh; `joints`: joint transforms, if the node has a skin. A mesh
    /// without either is added only once. Throws SceneFileError.
    Range add(std::size_t mesh, const Json& weights, const std::optional<JointMaps>& joints);

    /// Returns the number of bytes, according to the file, of the copy of a mesh for a node with a skin or with its own
    /// weights.
    double deformed_bytes(std::size_t mesh, bool is_skinned);
    /// Throws SceneFileError if all such copies together need more memory than is free.
    void check_deformed_bytes(double bytes) const;

private:
    /// Primitive of a mesh that is being added.
    struct Primitive {
        const Json& json;
        const Json& weights;  ///< weights of the morph targets
        const std::optional<JointMaps>& joints;
        std::string label;  ///< for messages
        std::uint32_t material;  ///< index in scene.materials
    };

    void add_primitive(const Primitive& primitive);
    /// Decodes a primitive of KHR_draco_mesh_compression, so that its accessors have their elements. Without the
    /// library, an uncompressed form is used; throws SceneFileError if there is none.
    void decode(const Primitive& primitive);
    /// True if positions and indices of a primitive have uncompressed bytes.
    bool has_uncompressed(const Primitive& primitive) const;
    /// Returns the names of the attributes that are read of a primitive.
    std::vector<std::string> attribute_names(const Primitive& primitive) const;
    /// Returns the index of a primitive's material; a default material is added on first use.
    std::uint32_t material_of(const Json& primitive, const std::string& label);
    /// Returns the index of a primitive's vertices in scene.vertices, adding them on first use.
    std::uint32_t vertices_of(const Primitive& primitive);
    /// Reads vertices and applies morph targets and skin. `uvs`, `second_uvs`: accessors of texture coordinates, or
    /// null.
    FileVertices read_vertices(const Primitive& primitive, const Json& uvs, const Json& second_uvs);
    /// Reads vertex colours, which are linear, with or without alpha, and clamped to 0..1.
    std::vector<VertexColor> read_colours(const Json& reference, const std::string& where);
    /// Applies the morph targets with their weights.
    void apply_targets(const Primitive& primitive, FileVertices& vertices);
    /// Reads the triangles of a primitive with this number of vertices; none if it has points or lines.
    std::vector<Triangle> read_triangles(const Primitive& primitive, std::size_t vertices);
    std::vector<std::uint32_t> read_indices(const Primitive& primitive, std::size_t vertices);
    /// Throws SceneFileError if all meshes, including the new one `mesh`, need more memory than is free: in a file of
    /// a megabyte, a thousand meshes may repeat a million vertices.
    void check_memory(const FileMesh& mesh);
    /// Throws SceneFileError if an attribute does not have one element for each vertex.
    void check_count(std::size_t count, std::size_t vertices, const std::string& where) const;

    /// Indices of the accessors of positions, normals, both sets of texture coordinates, and colours.
    using Attributes = std::tuple<std::size_t, std::size_t, std::size_t, std::size_t, std::size_t>;

    const GltfDocument& document_;
    GltfBuffers& buffers_;
    GltfAccessors& accessors_;
    FileScene& scene_;
    Checkpoint& checkpoint_;
    std::map<std::size_t, Range> added_;  ///< undeformed meshes, by index in the file
    std::map<std::pair<std::size_t, bool>, double> deformed_bytes_;  ///< results of deformed_bytes()
    std::map<Attributes, std::uint32_t> shared_vertices_;  ///< index in scene.vertices
    std::optional<std::uint32_t> default_material_;  ///< index in scene.materials
    /// Size of the meshes that have been added, and the size at which check_memory() checks again.
    std::size_t bytes_ = 0, next_check_ = std::size_t{1} << 28;
};

}  // namespace realcam::io
