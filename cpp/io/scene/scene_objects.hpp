#pragma once
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "../../scene/assembly.hpp"
#include "scene_part.hpp"

namespace realcam::io {

/// Selects the parts of a file that become instances instead of static geometry, and makes these instances. Such parts
/// are nodes that the caller names, and nodes that move, each with its descendants that do not move on their own;
/// meshes that deform; and meshes that are used so often that instancing saves memory.
class SceneObjects {
public:
    /// `scale`: metres per unit of the file; `names`: nodes that become instances. All arguments must outlive the
    /// object. Throws SceneFileError for a name that no node has.
    SceneObjects(const FileScene& file, double scale, const std::vector<std::string>& names, Checkpoint& checkpoint);

    /// Returns what of a node does not belong to the static geometry (LeftOutFunction).
    LeftOut left_out(std::uint32_t node, const Affine<double>& transform) const;

    /// Adds the instance of a node for which left_out() is not `nothing`. Warnings and suns go to `static_geometry`.
    /// Throws SceneFileError for a named node without triangles and without lights that have a position.
    void add(std::uint32_t node, const Affine<double>& transform, Scene& static_geometry);

    /// Returns the transform of a node, possibly animated, in metres. `transform`: its static transform to the scene.
    /// A node that an animation scales to zero has its transform at time 0, with a warning in `static_geometry`.
    AnimatedTransform placement(std::uint32_t node, const Affine<double>& transform, Scene& static_geometry);

    /// Returns the instances, with the materials and textures that they use. `materials`: scene with all materials and
    /// textures of the file. Must be called last, once.
    std::vector<Instance> finish(const Scene& materials);

private:
    /// Number of triangles that instancing must save; fewer triangles are intersected faster in one BVH with all
    /// others.
    static constexpr std::size_t kMinSavedTriangles = 1 << 20;

    /// Adds a node and, as its parts, the descendants that move or are named. `part_of`: index of the parent instance.
    void add_node(std::uint32_t node, const Affine<double>& transform, std::ptrdiff_t part_of, Scene& static_geometry);
    /// Adds the instance of the meshes of a node that deform.
    void add_deforming(std::uint32_t node, const Affine<double>& transform, std::ptrdiff_t part_of,
                       Scene& static_geometry);
    /// Adds the instance of a node whose object is `scene`, or a warning if it is scaled to zero while it moves.
    void add_scene(const std::shared_ptr<Scene>& scene, std::uint32_t node, const Affine<double>& transform,
                   std::ptrdiff_t part_of, Scene& static_geometry);
    /// Reads a node with those of its descendants that `leaves_out` does not exclude, in the node's frame. Suns go to
    /// `static_geometry`.
    std::shared_ptr<Scene> read_object(std::uint32_t node, const Affine<double>& transform,
                                       const LeftOutFunction& leaves_out, Scene& static_geometry) const;
    /// True if a node moves within its parent and has visible content.
    bool moves(std::uint32_t node) const { return file_.nodes[node].motion >= 0 && shows_[node]; }
    /// True if the meshes of a node deform.
    bool deforms(std::uint32_t node) const { return file_.nodes[node].deformation >= 0; }
    /// Returns the transform of a node to the scene, in metres, at a time in seconds.
    Affine<double> transform_at(std::uint32_t node, double time);
    /// Reads the meshes of a node, without its descendants, in the node's frame.
    std::shared_ptr<Scene> read_meshes(std::uint32_t node) const;

    /// Meshes of a node: index of the first one, and their number.
    using Meshes = std::pair<std::uint32_t, std::uint32_t>;
    Meshes meshes_of(std::uint32_t node) const { return {file_.nodes[node].first_mesh, file_.nodes[node].mesh_count}; }
    std::size_t triangle_count(const Meshes& meshes) const;

    const FileScene& file_;
    double scale_;
    Checkpoint& checkpoint_;
    std::set<std::string> names_;
    std::vector<bool> shows_;  ///< per node: it or a descendant has triangles or lights
    double products_ = 0;  ///< number of matrix products in transform_at
    std::set<Meshes> shared_;  ///< meshes that are used often enough for instancing
    std::map<Meshes, std::shared_ptr<Scene>> shared_scenes_;  ///< objects of these meshes
    std::vector<std::pair<std::shared_ptr<Scene>, Instance>>
        instances_;  ///< with their objects, which may still change
};

// These functions give materials and textures to a scene whose triangles have the material indices of `from`. Textures
// for which the scene has no texture coordinates are dropped.

/// Gives the scene all materials and textures, with the same indices.
void keep_all_materials(Scene& scene, Scene from);
/// Gives the scene only the materials and textures that it uses, with new indices.
void keep_used_materials(Scene& scene, const Scene& from);

}  // namespace realcam::io
