#pragma once
// What assimp makes of a file, before realcam looks at it.

#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gltf_document.hpp"

namespace realcam::io {

enum class SceneFormat { obj, gltf };

/// A file in memory, with polygons cut into triangles, finite vertices and indices in range.
class ImportedScene {
public:
    /// Throws SceneFileError if the file is broken.
    ImportedScene(const std::string& path, SceneFormat format);

    const aiScene& content() const { return *importer_.GetScene(); }
    SceneFormat format() const { return format_; }
    /// Null for an OBJ.
    const GltfDocument* gltf() const { return gltf_ ? &*gltf_ : nullptr; }
    /// Of a node relative to its parent.
    Affine<double> transform(const aiNode& node) const {
        return gltf_ ? gltf_->transform(node) : affine_from(node.mTransformation);
    }
    /// What assimp complained about and went on.
    const std::vector<std::string>& complaints() const { return complaints_; }

private:
    void check_meshes(const std::string& path) const;

    Assimp::Importer importer_;
    SceneFormat format_;
    std::optional<GltfDocument> gltf_;
    std::vector<std::string> complaints_;
};

/// How messages name a mesh: its number, from 0 as in the file, and its name if it has one.
std::string mesh_label(const aiScene& content, unsigned index);

}  // namespace realcam::io
