#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "../checkpoint.hpp"
#include "../math/keyframes.hpp"
#include "../math/vec3.hpp"

// Shapes that change over time: morph targets, then linear blend skinning (glTF 2.0, 3.7.2.2 and 3.7.3.3).

namespace REALCAM_NAMESPACE {

struct Scene;
struct Assembly;

/// Displacements by a morph target; one for each vertex, or an empty list for none.
struct MorphTarget {
    std::vector<Vec3f> positions, normals;
};

/// Joints that move each vertex, and their weights: `per_vertex` of them for each vertex.
struct VertexJoints {
    std::uint32_t per_vertex = 0;
    std::vector<std::uint32_t> joints;  ///< indices of joints
    std::vector<float> weights;
};

/// Node of a skeleton.
struct SkeletonNode {
    Affine<double> parent_from_node;  ///< used if it does not move
    std::shared_ptr<const NodeMotion> motion;  ///< null: it does not move within its parent
    std::int32_t parent = -1;  ///< index of the parent, which precedes the node; negative for a root
};

/// Deformation of the vertices of a Scene over time. Lengths are in units of the scene's file.
struct Deformation {
    double unit_m = 1;  ///< metres per unit
    std::vector<Vec3d> positions;  ///< at rest, one for each vertex
    std::vector<Vec3f> normals;  ///< at rest; empty, or one for each vertex; (0, 0, 0): flat shading
    std::vector<MorphTarget> targets;
    std::shared_ptr<const VectorKeys> target_weights;  ///< one component for each target; null: there are no targets
    std::vector<SkeletonNode> nodes;
    std::vector<std::uint32_t> joint_nodes;  ///< index in `nodes` of each joint
    std::vector<Affine<double>> node_from_rest;  ///< inverse bind matrix of each joint
    VertexJoints vertex_joints;  ///< empty if there are no joints
};

/// Returns why a deformation is invalid for a scene with this number of vertices; empty if it is valid.
std::string deformation_error(const Deformation& deformation, std::size_t vertices);

/// Adds the displacements of a morph target, times its weight. Normals may be empty.
void add_target(std::vector<Vec3d>& positions, std::vector<Vec3f>& normals, const MorphTarget& target, double weight);

/// Transforms positions and normals by the weighted mean of the vertex's joint transforms; weights need not sum to 1.
/// Vertices without weights remain as they are. Normals may be empty.
void apply_skin(std::vector<Vec3d>& positions, std::vector<Vec3f>& normals, const VertexJoints& vertex_joints,
                const std::vector<Affine<double>>& joints, Checkpoint& checkpoint);

/// Sets positions and normals of a scene to those of its deformation, which it must have, at a time in seconds.
void set_shape(Scene& scene, double time_s);

/// Rigid objects by the deforming objects whose shape at some time they have.
using Shapes = std::map<std::shared_ptr<const Scene>, std::shared_ptr<const Scene>>;

/// Returns the scene with rigid objects in place of those that deform, in their shapes at a time in seconds, without
/// their degenerate triangles. `known`: shapes of that time, which are reused; receives those of this scene. Throws
/// InputError if a vertex would be out of reach.
Assembly with_shapes_at(Assembly assembly, double time_s, Shapes& known);

}  // namespace REALCAM_NAMESPACE
