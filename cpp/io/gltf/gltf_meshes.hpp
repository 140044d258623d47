#pragma once
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "../scene/file_scene.hpp"
#include "gltf_draco_primitive.hpp"
#include "gltf_skins.hpp"

namespace realcam::io {

/// Deformation of the mesh of a node.
struct GltfShape {
    /// Weights of the morph targets; empty if they are those of the mesh.
    std::vector<double> target_weights;
    /// Joint maps of a skin that does not move.
    std::optional<JointMaps> joints;
    std::size_t moving_joints = 0;  ///< number of joints of a skin that moves
    std::size_t moving_targets = 0;  ///< number of morph targets if their weights change over time

    bool moves() const { return moving_joints > 0 || moving_targets > 0; }
    bool is_skinned() const { return joints.has_value() || moving_joints > 0; }
    /// True if the mesh of the file is used without a change.
    bool is_plain() const { return target_weights.empty() && !joints && !moves(); }
};

/// Returns the weights of morph targets that a JSON array lists.
std::vector<double> target_weights_of(const Json& list);

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

    /// Adds a mesh and returns its primitives. `mesh`: index in the file. Constant weights and joints are applied; for
    /// those that move, the vertices get targets and joints. A mesh with a plain shape is added only once. Throws
    /// SceneFileError.
    Range add(std::size_t mesh, const GltfShape& shape);

    /// Returns the number of bytes, according to the file, of the copy of a mesh for a node with a skin or with its own
    /// weights. `has_moving_targets`: the weights change over time.
    double deformed_bytes(std::size_t mesh, bool is_skinned, bool has_moving_targets);
    /// Throws SceneFileError if all such copies together need more memory than is free.
    void check_deformed_bytes(double bytes) const;

private:
    /// Primitive of a mesh that is being added.
    struct Primitive {
        const Json& json;
        const std::vector<double>& target_weights;
        const GltfShape& shape;
        std::string label;  ///< for messages
        std::uint32_t material;  ///< index in scene.materials
    };

    void add_primitive(const Primitive& primitive);
    /// Returns the names of the attributes that are read of a primitive.
    std::vector<std::string> attribute_names(const Primitive& primitive) const;
    /// Returns the index of a primitive's material; a default material is added on first use.
    std::uint32_t material_of(const Json& primitive, const std::string& label);
    /// Returns the index of a primitive's vertices in scene.vertices, adding them on first use.
    std::uint32_t vertices_of(const Primitive& primitive);
    /// Reads vertices and applies morph targets and skin, or keeps them if they move. `uvs`, `second_uvs`: accessors of
    /// texture coordinates, or null.
    FileVertices read_vertices(const Primitive& primitive, const Json& uvs, const Json& second_uvs);
    /// Reads vertex colours, which are linear, with or without alpha, and clamped to 0..1.
    std::vector<VertexColor> read_colours(const Json& reference, const std::string& where);
    /// Reads a morph target of a primitive with this number of vertices.
    MorphTarget read_target(const Primitive& primitive, std::size_t target, std::size_t vertices);
    /// Applies the morph targets with their weights, or keeps those that move.
    void read_targets(const Primitive& primitive, FileVertices& vertices);
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
    std::map<std::tuple<std::size_t, bool, bool>, double> deformed_bytes_;  ///< results of deformed_bytes()
    std::map<Attributes, std::uint32_t> shared_vertices_;  ///< index in scene.vertices
    std::optional<std::uint32_t> default_material_;  ///< index in scene.materials
    /// Size of the meshes that have been added, and the size at which check_memory() checks again.
    std::size_t bytes_ = 0, next_check_ = std::size_t{1} << 28;
};

}  // namespace realcam::io
