#pragma once
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "../scene/assembly.hpp"
#include "scene_part.hpp"

namespace realcam::io {

/// What of a file stands as objects instead of being a part of static geometry: nodes that the caller names, with all
/// below them, and meshes that stand in so many places that their triangles are worth sharing.
class SceneObjects {
public:
    /// All arguments have to outlive it. Throws SceneFileError for a name that no node has.
    SceneObjects(const ImportedScene& file, const std::string& path, double scale,
                 const std::vector<std::string>& names);

    LeftOut left_out(const aiNode& node, const Affine<double>& transform) const;

    /// Of a node that is left out. Warnings go to `static_geometry`. Throws SceneFileError for one without triangles
    /// and lights.
    void add(const aiNode& node, const Affine<double>& transform, Scene& static_geometry);

    /// With the materials and textures that they use, of those that the file has.
    std::vector<Instance> finish(const Scene& materials);

private:
    /// Meshes of a node that are worth sharing once more; fewer triangles are met faster in one hierarchy with all
    /// others.
    static constexpr std::size_t kSharedTriangles = 1 << 20;

    std::shared_ptr<Scene> read_object(const aiNode& node, const Affine<double>& transform,
                                       Scene& static_geometry) const;
    std::shared_ptr<Scene> read_meshes(const aiNode& node) const;

    using Meshes = std::vector<unsigned>;
    static Meshes meshes_of(const aiNode& node) { return {node.mMeshes, node.mMeshes + node.mNumMeshes}; }
    void count_uses(const aiNode& node, std::map<Meshes, std::size_t>& uses, std::set<std::string>& found) const;

    const ImportedScene& file_;
    const std::string& path_;
    double scale_;
    const std::vector<std::string>& names_;
    std::set<Meshes> shared_;
    std::map<Meshes, std::shared_ptr<Scene>> shared_scenes_;
    std::vector<std::pair<std::shared_ptr<Scene>, Instance>> instances_;
};

/// Gives a scene whose triangles have the material numbers of `from` those materials and textures, or of them those
/// that it uses, under new numbers. No textures where there are no texture coordinates.
void keep_all_materials(Scene& scene, Scene from);
void keep_used_materials(Scene& scene, const Scene& from);

}  // namespace realcam::io
