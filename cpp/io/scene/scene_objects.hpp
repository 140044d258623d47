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

/// Selects the parts of a file that become instances instead of static geometry: nodes that the caller names, and nodes
/// that move, each with its descendants that do not move on their own; and meshes with enough copies for sharing their
/// triangles to pay.
class SceneObjects {
public:
    /// All arguments have to outlive the object. Throws SceneFileError for a name that no node has.
    SceneObjects(const FileScene& file, double scale, const std::vector<std::string>& names, Checkpoint& checkpoint);

    LeftOut left_out(std::uint32_t node, const Affine<double>& transform) const;

    /// Adds the object of a node that is not in the static geometry. Warnings go to `static_geometry`. Throws
    /// SceneFileError for a named node without triangles and lights.
    void add(std::uint32_t node, const Affine<double>& transform, Scene& static_geometry);

    /// Returns the transform of a node, possibly animated, in metres. `transform`: its static transform to the scene.
    AnimatedTransform placement(std::uint32_t node, const Affine<double>& transform);

    /// Returns the instances, with the materials and textures of the file that they use.
    std::vector<Instance> finish(const Scene& materials);

private:
    /// Number of triangles saved from which on sharing pays; fewer triangles are intersected faster in one BVH with all
    /// others.
    static constexpr std::size_t kSharedTriangles = 1 << 20;

    void add_node(std::uint32_t node, const Affine<double>& transform, std::ptrdiff_t part_of, Scene& static_geometry);
    void add_scene(const std::shared_ptr<Scene>& scene, std::uint32_t node, const Affine<double>& transform,
                   std::ptrdiff_t part_of, Scene& static_geometry);
    std::shared_ptr<Scene> read_object(std::uint32_t node, const Affine<double>& transform, const LeavesOut& leaves_out,
                                       Scene& static_geometry) const;
    /// True if a node moves within its parent and has visible content.
    bool moves(std::uint32_t node) const { return file_.nodes[node].motion >= 0 && shows_[node]; }
    Affine<double> transform_at(std::uint32_t node, double time);
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
    double matrices_ = 0;  ///< number of products in transform_at
    std::set<Meshes> shared_;
    std::map<Meshes, std::shared_ptr<Scene>> shared_scenes_;
    std::vector<std::pair<std::shared_ptr<Scene>, Instance>> instances_;
};

/// Gives materials and textures to a scene whose triangles have the material indices of `from`: all of them, or only
/// those that it uses, with new indices. Textures without their texture coordinates are dropped.
void keep_all_materials(Scene& scene, Scene from);
void keep_used_materials(Scene& scene, const Scene& from);

}  // namespace realcam::io
