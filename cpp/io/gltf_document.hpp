#pragma once
// What assimp leaves out of a glTF file, or rounds, read from the file's own JSON.

#include <assimp/scene.h>

#include <functional>
#include <map>
#include <string>

#include "affine.hpp"
#include "json.hpp"

namespace realcam::io {

class GltfDocument {
public:
    /// Reads the JSON of a .gltf or .glb. Throws SceneFileError: no JSON, or an extension is required that changes how
    /// geometry is stored and that assimp does not know.
    explicit GltfDocument(const std::string& path);

    /// Finds for every node, mesh and material that assimp made the one of the file that it comes from; assimp numbers
    /// them anew and keeps no trace. Throws SceneFileError if a mesh lost triangles, which is how assimp answers
    /// indices out of range.
    void match(const aiScene& content);

    /// Null if the file does not have the node, such as the root that assimp puts above several others.
    const Json& node(const aiNode& from) const;
    /// Relative to the parent, in double precision.
    Affine<double> transform(const aiNode& from) const;
    /// Null for a mesh without a material.
    const Json& material(unsigned assimp_index) const;
    const Json& root() const { return root_; }

private:
    void match_node(const aiScene& content, const aiNode& made, std::size_t index);
    void check_faces(const aiMesh& made, std::size_t mesh, std::size_t primitive) const;

    std::string path_;
    Json root_;
    std::map<const aiNode*, const Json*> nodes_;
    std::map<unsigned, const Json*> materials_;
};

}  // namespace realcam::io
