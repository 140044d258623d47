#pragma once
// Content of a scene file, independent of its format: the readers fill it, and scene_geometry, scene_objects,
// scene_lights and scene_materials make a Scene of it.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "../../math/affine.hpp"
#include "../../math/keyframes.hpp"
#include "../../math/vec3.hpp"
#include "../../scene/deformation.hpp"
#include "../../scene/scene_view.hpp"
#include "gltf_material.hpp"
#include "texture_transform.hpp"

namespace realcam::io {

// Materials as described in scene files. Only scene_materials.cpp decides how they are rendered.

/// Material of an MTL file (Alias|Wavefront, File Formats 4.2, 1995), with later additions: Ke, norm, and the
/// statements for physically based rendering, which begin with P. Members have the names of the format.
struct MtlMaterial {
    Vec3f Ka = {0, 0, 0};           ///< ambient; not needed by a path tracer
    Vec3f Kd = {0.6f, 0.6f, 0.6f};  ///< diffuse; the format has no default; many viewers use this one
    Vec3f Ks = {0, 0, 0};           ///< specular
    Vec3f Ke = {0, 0, 0};           ///< emission
    Vec3f Tf = {1, 1, 1};           ///< transmission filter
    float Ns = 0;             ///< Phong exponent
    std::optional<float> Ni;  ///< index of refraction, 0.001 to 10
    float d = 1;              ///< 0..1, 1 is opaque; Tr is 1 - d

    /// Illumination model, 0 to 10. The format has no default. Model 2 has highlights, and model 1 only colour and
    /// ambient; so it is 2 for a material that has Ks, and 1 for others.
    int illum = 1;

    std::optional<float> Pr, Pm;  ///< roughness and metallic, 0..1; either one selects that model
    float Pc = 0, Pcr = 0;  ///< clearcoat and its roughness, 0..1

    FileTexture map_Kd, map_Ks, map_Ke;  ///< colours that multiply Kd, Ks and Ke
    FileTexture map_d, map_Ns, map_Pr, map_Pm;  ///< numbers that multiply d, Ns, Pr and Pm
    FileTexture bump;  ///< heights, bright is high
    float bm = 1;  ///< factor of those heights
    FileTexture norm;  ///< normals in tangent space
};

/// Material of a scene file. Without content it is the default for meshes without a material.
struct FileMaterial {
    std::string name;
    std::variant<std::monostate, MtlMaterial, GltfMaterial> content;
    /// Without content: white instead of grey, because the vertex colours are the surface's colours.
    bool is_white = false;

    /// Returns the texture of the surface's colour.
    FileTexture colour_texture() const {
        if (const auto* mtl = std::get_if<MtlMaterial>(&content)) return mtl->map_Kd;
        const auto* gltf = std::get_if<GltfMaterial>(&content);
        return gltf ? gltf->colour_texture() : FileTexture{};
    }

    /// Returns the numbers n of the sets TEXCOORD_n that the textures use, at most two, in the order in which the
    /// vertices of the material's meshes get them as uvs and second_uvs. {0} for materials of other formats.
    std::vector<std::uint32_t> uv_sets() const {
        const auto* gltf = std::get_if<GltfMaterial>(&content);
        return gltf && !gltf->uv_sets.empty() ? gltf->uv_sets : std::vector<std::uint32_t>{0};
    }
};

/// Vertices, in units of the file. Several meshes may share them.
struct FileVertices {
    std::vector<Vec3d> positions;
    std::vector<Vec3f> normals;  ///< empty, or one per position; (0, 0, 0) if a vertex has no normal
    std::vector<Vec2f> uvs;  ///< empty, or one per position; as in the file, except that v is upwards
    std::vector<Vec2f> second_uvs;  ///< like uvs
    std::vector<VertexColor> colours;  ///< empty, or one per position; linear
    std::vector<std::uint32_t> position_ids;  ///< empty, or one per position: see Smoothing
    std::vector<MorphTarget> targets;  ///< morph targets with weights that change over time
    VertexJoints joints;  ///< joints of a skin that moves; indices in FileDeformation::joints
};

/// Joint of a skin.
struct FileJoint {
    std::uint32_t node;  ///< index in FileScene::nodes
    Affine<double> node_from_rest;  ///< inverse bind matrix
};

/// Deformation of a node's meshes over time.
struct FileDeformation {
    std::shared_ptr<const VectorKeys> target_weights;  ///< null: no morph target of the meshes changes
    std::vector<FileJoint> joints;  ///< empty: no skin moves the meshes, which are in the frame of the node;
                                    ///< otherwise they are in that of the scene
};

/// Triangles of a file that share a list of vertices.
struct FileMesh {
    std::string label;  ///< for messages
    std::uint32_t vertices = 0;  ///< index in FileScene::vertices
    std::vector<Triangle> triangles;  ///< indices in range; material: index in FileScene::materials
    /// Smoothing group of each triangle without normals; 0 is flat. If this is empty, FileScene::smooths_by_angle
    /// decides.
    std::vector<std::uint32_t> smoothing;
};

constexpr std::uint32_t kNoParent = 0xffffffffu;  ///< FileNode::parent of a root

/// Node of the hierarchy. Nodes are in depth-first order: the descendants of node i are i + 1 to end - 1.
struct FileNode {
    std::string name;  ///< valid UTF-8
    Affine<double> parent_from_node;  ///< in units of the file
    std::uint32_t parent = kNoParent;  ///< index of the parent
    std::uint32_t end = 0;  ///< index behind the last descendant
    std::uint32_t first_mesh = 0, mesh_count = 0;  ///< range in FileScene::meshes
    std::int32_t light = -1;  ///< index in FileScene::lights, or -1
    std::int32_t camera = -1;  ///< index in FileScene::cameras, or -1
    std::int32_t motion = -1;  ///< index in FileScene::motions; -1 if the node does not move
    std::int32_t deformation = -1;  ///< index in FileScene::deformations; -1 if its meshes do not deform
};

/// Picture used by materials.
struct FilePicture {
    std::string name;  ///< name in the file; for an embedded picture, a label
    bool is_embedded = false;  ///< the scene file holds the picture
    std::string bytes;  ///< bytes of an embedded picture, encoded as PNG or JPEG; empty if they cannot be read
};

/// Light of KHR_lights_punctual. Its position and direction are those of its node.
struct FileLight {
    std::string type;  ///< type in KHR_lights_punctual: point, directional, spot, or another word in the file
    Vec3d strength;  ///< colour times intensity: cd, or lux for "directional"
    /// Angles from a spot's axis, in radians, at which its falloff begins and ends. 0 <= inner <= outer <= pi / 2.
    double inner_cone_angle = 0, outer_cone_angle = 0.785398163397448;
};

/// Camera of a file. Its pose is that of its node.
struct FileCamera {
    std::string name;  ///< valid UTF-8
    double vertical_field_rad = 0;  ///< vertical field of view in radians; 0: orthographic
};

/// Content of a scene file.
struct FileScene {
    std::string path;
    bool smooths_by_angle = false;  ///< triangles without normals are smoothed by angle instead of flat
    std::vector<FileVertices> vertices;
    std::vector<FileMesh> meshes;
    std::vector<FileNode> nodes;
    std::vector<NodeMotion> motions;
    std::vector<FileDeformation> deformations;
    std::vector<FileMaterial> materials;
    std::vector<FilePicture> pictures;
    std::vector<FileLight> lights;
    std::vector<FileCamera> cameras;
    std::vector<std::string> warnings;  ///< without the path
};

}  // namespace realcam::io
