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

/// Which parts of a file become instances instead of static geometry. They are nodes that the caller names, and nodes
/// that move, with all below them that does not move otherwise. So are meshes with so many copies that their triangles
/// are worth sharing.
class SceneObjects {
public:
    /// All arguments have to outlive it. Throws SceneFileError for a name that no node has.
    SceneObjects(const FileScene& file, double scale, const std::vector<std::string>& names, Checkpoint& checkpoint);

    LeftOut left_out(std::uint32_t node, const Affine<double>& transform) const;

    /// Adds the object of a node that static geometry leaves out. Warnings go to `static_geometry`. Throws
    /// SceneFileError for one without triangles and lights.
    void add(std::uint32_t node, const Affine<double>& transform, Scene& static_geometry);

    /// Where a node is, or how it moves, in metres. `transform`: its own, in the scene.
    Placement placement(std::uint32_t node, const Affine<double>& transform);

    /// With the materials and textures that they use, of those that the file has. Of several with one name, the second
    /// is "name.2" and so on.
    std::vector<Instance> finish(const Scene& materials);

private:
    /// Triangles, or vertices, of a node that are worth sharing once more; fewer triangles are met faster in one
    /// hierarchy with all others.
    static constexpr std::size_t kSharedTriangles = 1 << 20;

    void add_node(std::uint32_t node, const Affine<double>& transform, std::ptrdiff_t part_of, Scene& static_geometry);
    void add_scene(const std::shared_ptr<Scene>& scene, std::uint32_t node, const Affine<double>& transform,
                   std::ptrdiff_t part_of, Scene& static_geometry);
    std::shared_ptr<Scene> read_object(std::uint32_t node, const Affine<double>& transform, const LeavesOut& leaves_out,
                                       Scene& static_geometry) const;
    /// Whether a node moves within its parent, and shows it.
    bool moves(std::uint32_t node) const { return file_.nodes[node].motion >= 0 && shows_[node]; }
    Affine<double> transform_at(std::uint32_t node, double time);
    std::shared_ptr<Scene> read_meshes(std::uint32_t node) const;

    /// The meshes of a node: the first of them, and how many there are.
    using Meshes = std::pair<std::uint32_t, std::uint32_t>;
    Meshes meshes_of(std::uint32_t node) const { return {file_.nodes[node].first_mesh, file_.nodes[node].mesh_count}; }
    std::size_t triangle_count(const Meshes& meshes) const;

    const FileScene& file_;
    double scale_;
    Checkpoint& checkpoint_;
    std::set<std::string> names_;
    std::vector<bool> shows_;  ///< of the nodes: has triangles or lights, or those below have
    double matrices_ = 0;  ///< that transform_at has multiplied
    std::set<Meshes> shared_;
    std::map<Meshes, std::shared_ptr<Scene>> shared_scenes_;
    std::vector<std::pair<std::shared_ptr<Scene>, Instance>> instances_;
};

/// Gives a scene whose triangles have the material numbers of `from` those materials and textures, or of them those
/// that it uses, under new numbers. No textures where there are no texture coordinates.
void keep_all_materials(Scene& scene, Scene from);
void keep_used_materials(Scene& scene, const Scene& from);

}  // namespace realcam::io
