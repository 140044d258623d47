#pragma once
// What a scene file says, whatever its format: the readers write it, and scene_geometry, scene_objects, scene_lights
// and scene_materials make a Scene of it.

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
    std::vector<Vec3f> normals;  ///< empty, or one per position; (0, 0, 0): none
    std::vector<Vec2f> uvs;      ///< empty, or one per position, as the file has them but for v, which is upwards
    std::vector<Vec2f> second_uvs;  ///< the same
    std::vector<VertexColor> colours;  ///< empty, or one per position; linear
    std::vector<std::uint32_t> places;  ///< empty, or one per position: see Smoothing
};

struct FileMesh {
    std::string label;  ///< for messages
    std::uint32_t vertices = 0;  ///< number in FileScene::vertices
    std::vector<Triangle> triangles;  ///< indices in range; material: number in FileScene::materials
    /// The smoothing group of each triangle without normals; 0 is flat. Where it is empty, FileScene::smooths decides.
    std::vector<std::uint32_t> smoothing;
};

constexpr std::uint32_t kNoParent = 0xffffffffu;

/// Nodes stand in depth-first order: those below number i are i + 1 to end - 1.
struct FileNode {
    std::string name;  ///< valid UTF-8
    Affine<double> parent_from_node;
    std::uint32_t parent = kNoParent, end = 0;
    std::uint32_t first_mesh = 0, mesh_count = 0;  ///< in FileScene::meshes
    std::int32_t light = -1;  ///< number in FileScene::lights
    std::int32_t camera = -1;  ///< number in FileScene::cameras
    std::int32_t motion = -1;  ///< number in FileScene::motions; below 0: it stays where it is
};

/// A picture that materials name.
struct FilePicture {
    std::string name;  ///< as the file spells it; of one inside the file, a label
    bool is_inside = false;
    std::string bytes;  ///< of one inside the file: encoded, as PNG or JPEG; empty where they cannot be had
};

struct FileLight {
    std::string type;  ///< of KHR_lights_punctual: point, directional, spot, or what else the file says
    Vec3d strength;  ///< colour times intensity: cd, or lux for "directional"
    /// Angles of a spot from its axis, in radians: where it begins to fade, and where it ends. 0 <= inner <= outer <=
    /// pi / 2.
    double inner_cone_angle = 0, outer_cone_angle = 0.785398163397448;
};

struct FileCamera {
    std::string name;  ///< valid UTF-8
    double vertical_field_rad = 0;  ///< 0: orthographic
};

struct FileScene {
    std::string path;
    bool smooths = false;  ///< whether triangles without normals are smooth by angle, and not flat
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
