#pragma once
// Content of a scene file, independent of its format: the readers fill it, and scene_geometry, scene_objects,
// scene_lights and scene_materials make a Scene of it.

#include <cstdint>
#include <string>
#include <vector>

#include "../../math/affine.hpp"
#include "../../scene/scene_view.hpp"
#include "file_material.hpp"
#include "file_motion.hpp"

namespace realcam::io {

/// Vertices, in units of the file. Several meshes may share them.
struct FileVertices {
    std::vector<Vec3d> positions;
    std::vector<Vec3f> normals;  ///< empty, or one per position; (0, 0, 0) if a vertex has no normal
    std::vector<Vec2f> uvs;      ///< empty, or one per position; as in the file, except that v is upwards
    std::vector<Vec2f> second_uvs;  ///< like uvs
    std::vector<VertexColor> colours;  ///< empty, or one per position; linear
    std::vector<std::uint32_t> position_ids;  ///< empty, or one per position: see Smoothing
};

struct FileMesh {
    std::string label;  ///< for messages
    std::uint32_t vertices = 0;  ///< index in FileScene::vertices
    std::vector<Triangle> triangles;  ///< indices in range; material: index in FileScene::materials
    /// Smoothing group of each triangle without normals; 0 is flat. If this is empty, FileScene::smooths decides.
    std::vector<std::uint32_t> smoothing;
};

constexpr std::uint32_t kNoParent = 0xffffffffu;

/// Node of the hierarchy. Nodes are in depth-first order: the descendants of node i are i + 1 to end - 1.
struct FileNode {
    std::string name;  ///< valid UTF-8
    Affine<double> parent_from_node;
    std::uint32_t parent = kNoParent, end = 0;
    std::uint32_t first_mesh = 0, mesh_count = 0;  ///< in FileScene::meshes
    std::int32_t light = -1;  ///< index in FileScene::lights, or -1
    std::int32_t camera = -1;  ///< index in FileScene::cameras, or -1
    std::int32_t motion = -1;  ///< index in FileScene::motions; -1 if the node does not move
};

/// Picture used by materials.
struct FilePicture {
    std::string name;  ///< name in the file; for an embedded picture, a label
    bool is_inside = false;
    std::string bytes;  ///< bytes of an embedded picture, encoded as PNG or JPEG; empty if they cannot be read
};

struct FileLight {
    std::string type;  ///< type in KHR_lights_punctual: point, directional, spot, or another word in the file
    Vec3d strength;  ///< colour times intensity: cd, or lux for "directional"
    /// Angles of a spot from its axis, in radians, at which it begins and ends to fade. 0 <= inner <= outer <= pi / 2.
    double inner_cone_angle = 0, outer_cone_angle = 0.785398163397448;
};

struct FileCamera {
    std::string name;  ///< valid UTF-8
    double vertical_field_rad = 0;  ///< 0: orthographic
};

struct FileScene {
    std::string path;
    bool smooths = false;  ///< triangles without normals are smoothed by angle instead of flat
    std::vector<FileVertices> vertices;
    std::vector<FileMesh> meshes;
    std::vector<FileNode> nodes;
    std::vector<FileMotion> motions;
    std::vector<FileMaterial> materials;
    std::vector<FilePicture> pictures;
    std::vector<FileLight> lights;
    std::vector<FileCamera> cameras;
    std::vector<std::string> warnings;  ///< without the path
};

}  // namespace realcam::io
