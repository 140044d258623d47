#include "scene_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "../error.hpp"
#include "affine.hpp"
#include "scene_cleanup.hpp"
#include "texture_transform.hpp"

namespace realcam::io {
namespace {

Vec3d as_vec3d(const aiVector3D& v) {
    return {double(v.x), double(v.y), double(v.z)};
}

class Flattener {
public:
    Flattener(Scene& scene, const ScenePart& part, const LeavesOut& leaves_out)
        : scene_(scene), file_(part.file), path_(part.path), scale_(part.scale), leaves_out_(leaves_out) {
        const aiScene& content = file_.content();
        for (unsigned m = 0; m < content.mNumMeshes; ++m) {
            any_normals_ |= content.mMeshes[m]->HasNormals();
            any_uvs_ |= content.mMeshes[m]->HasTextureCoords(uv_channel(*content.mMeshes[m]));
        }
    }

    void add_node(const aiNode& node, const Affine<double>& transform) {
        const LeftOut left_out = leaves_out_(node, transform);
        left_out_ |= left_out != LeftOut::nothing;
        if (left_out == LeftOut::all) return;
        if (left_out == LeftOut::nothing)
            for (unsigned i = 0; i < node.mNumMeshes; ++i) add_mesh(node.mMeshes[i], transform);
        for (unsigned i = 0; i < node.mNumChildren; ++i) {
            const aiNode& child = *node.mChildren[i];
            add_node(child, transform * file_.transform(child));
        }
    }

    void finish() {
        if (!left_out_ || !scene_.triangles.empty()) clean_geometry(scene_, smooth_, path_);
        warn_count(scene_, path_, bad_normals_, "normals are no finite numbers; their faces are flat there");
        warn_count(scene_, path_, bad_uvs_, "texture coordinates are no finite numbers, 0 taken");
        warn_count(scene_, path_, uncovered_, "meshes have a texture and no coordinates for it");
        warn_count(scene_, path_, coloured_, "meshes have colours at their vertices, which are not read");
    }

private:
    const Json& texture_info(const aiMesh& mesh) const {
        const GltfDocument* gltf = file_.gltf();
        return gltf ? gltf->material(mesh.mMaterialIndex)["pbrMetallicRoughness"]["baseColorTexture"] : none_;
    }

    unsigned uv_channel(const aiMesh& mesh) const {
        const Json& moved = texture_info(mesh)["extensions"]["KHR_texture_transform"]["texCoord"];
        if (moved.is_number()) return static_cast<unsigned>(std::min<std::size_t>(moved.index(0), 7));
        int channel = 0;
        file_.content().mMaterials[mesh.mMaterialIndex]->Get(AI_MATKEY_UVWSRC_DIFFUSE(0), channel);
        return channel >= 0 && channel < AI_MAX_NUMBER_OF_TEXTURECOORDS ? static_cast<unsigned>(channel) : 0u;
    }

    void add_mesh(unsigned index, const Affine<double>& transform) {
        const aiMesh& mesh = *file_.content().mMeshes[index];
        const std::size_t first = scene_.positions_m.size();
        if (first + mesh.mNumVertices > std::numeric_limits<std::uint32_t>::max()) {
            throw SceneFileError(path_ + ": more than 4294967295 vertices");
        }
        add_vertices(mesh, transform);

        const bool smooth = !mesh.HasNormals() && file_.format() == SceneFormat::obj;
        const bool mirrored = transform.determinant() < 0;
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            if (face.mNumIndices != 3) continue;  // points and lines
            Triangle t{{0, 0, 0}, mesh.mMaterialIndex};
            for (int i = 0; i < 3; ++i) t.vertices[i] = static_cast<std::uint32_t>(first + face.mIndices[i]);
            if (mirrored) std::swap(t.vertices[1], t.vertices[2]);
            if (smooth) smooth_.push_back(static_cast<std::uint32_t>(scene_.triangles.size()));
            scene_.triangles.push_back(t);
        }
    }

    void add_vertices(const aiMesh& mesh, const Affine<double>& transform) {
        const aiVector3D* uvs = mesh.mTextureCoords[uv_channel(mesh)];
        const TextureTransform move_uv(texture_info(mesh));
        aiString texture;
        const aiMaterial& material = *file_.content().mMaterials[mesh.mMaterialIndex];
        if (!uvs && material.GetTexture(aiTextureType_DIFFUSE, 0, &texture) == aiReturn_SUCCESS) ++uncovered_;
        if (mesh.HasVertexColors(0)) ++coloured_;

        for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
            scene_.positions_m.push_back(scale_ * transform.point(as_vec3d(mesh.mVertices[v])));
            if (any_normals_)
                scene_.normals.push_back(mesh.HasNormals() ? normal(mesh.mNormals[v], transform) : Vec3f{});
            if (any_uvs_) scene_.uvs.push_back(uvs ? uv(uvs[v], move_uv) : Vec2f{});
        }
    }

    Vec3f normal(const aiVector3D& given, const Affine<double>& transform) {
        if (!std::isfinite(given.x + given.y + given.z)) {
            ++bad_normals_;
            return {0, 0, 0};
        }
        const Vec3d n = transform.normal(as_vec3d(given));
        const double size = length(n);
        return size > 0 && std::isfinite(size) ? static_cast<Vec3f>((1 / size) * n) : Vec3f{0, 0, 0};
    }

    Vec2f uv(const aiVector3D& given, const TextureTransform& move) {
        if (std::isfinite(given.x + given.y)) return move(given.x, given.y);
        ++bad_uvs_;
        return {0, 0};
    }

    Scene& scene_;
    const ImportedScene& file_;
    const std::string& path_;
    double scale_;
    const LeavesOut& leaves_out_;
    bool left_out_ = false;
    bool any_normals_ = false, any_uvs_ = false;
    std::vector<std::uint32_t> smooth_;
    const Json none_;
    std::size_t bad_normals_ = 0, bad_uvs_ = 0, uncovered_ = 0, coloured_ = 0;
};

}  // namespace

void read_geometry(Scene& scene, const ScenePart& part, const LeavesOut& leaves_out) {
    Flattener flattener(scene, part, leaves_out);
    flattener.add_node(part.node, part.transform);
    flattener.finish();
}

}  // namespace realcam::io
