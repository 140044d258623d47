#include "gltf_document.hpp"

#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "../error.hpp"

namespace realcam::io {
namespace {

constexpr std::size_t no_index = std::numeric_limits<std::size_t>::max();

const Json nothing;

// A GLB is a header of 12 bytes, then chunks of a length, a kind and their bytes; JSON is the first.
std::string json_text(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (!text.starts_with("glTF")) {
        if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);
        return text;
    }
    const auto word = [&](std::size_t at) {
        unsigned value = 0;  // little-endian
        for (std::size_t i = 4; i-- > 0;) value = 256 * value + static_cast<unsigned char>(text[at + i]);
        return value;
    };
    if (text.size() < 20) throw SceneFileError(path + ": ends inside the header of a GLB");
    if (word(4) != 2) throw SceneFileError(path + ": is glTF " + std::to_string(word(4)) + "; glTF 2.0 is wanted");
    if (word(8) > text.size()) {
        throw SceneFileError(path + ": is cut short: " + std::to_string(text.size()) + " of " +
                             std::to_string(word(8)) + " bytes");
    }
    if (std::memcmp(text.data() + 16, "JSON", 4) != 0) throw SceneFileError(path + ": a JSON chunk is wanted first");
    return text.substr(20, word(12));
}

// A required extension that is not listed here means other geometry than assimp would read.
bool may_be_required(const std::string& extension) {
    return extension == "KHR_lights_punctual" || extension == "KHR_texture_transform" ||
           extension.starts_with("KHR_materials_");
}

Vec3d vec3d(const Json& numbers, Vec3d otherwise) {
    return {numbers[std::size_t{0}].number(otherwise.x), numbers[1].number(otherwise.y),
            numbers[2].number(otherwise.z)};
}

}  // namespace

GltfDocument::GltfDocument(const std::string& path) : path_(path) {
    try {
        root_ = Json::parse(json_text(path));
    } catch (const std::runtime_error& error) {
        if (dynamic_cast<const Error*>(&error)) throw;
        throw SceneFileError(path + ": is no valid glTF: " + error.what());
    }
    const std::string version = root_["asset"]["version"].text();
    if (!version.starts_with('2')) {
        throw SceneFileError(path + ": is glTF " + (version.empty() ? "of no version" : version) +
                             "; glTF 2.0 is wanted");
    }
    for (std::size_t i = 0; i < root_["extensionsRequired"].size(); ++i) {
        const std::string name = root_["extensionsRequired"][i].text();
        if (!may_be_required(name)) {
            throw SceneFileError(path + ": needs the glTF extension " + name +
                                 ", which is not read; export it without compression");
        }
    }
}

void GltfDocument::match(const aiScene& content) {
    const Json& roots = root_["scenes"][root_["scene"].index(0)]["nodes"];
    // assimp keeps the tree, and puts a node above it if it has several roots.
    if (roots.size() == 1) {
        match_node(content, *content.mRootNode, roots[std::size_t{0}].index(no_index));
    } else {
        if (content.mRootNode->mNumChildren != roots.size()) throw SceneFileError(path_ + ": a root node is not there");
        for (std::size_t i = 0; i < roots.size(); ++i) {
            match_node(content, *content.mRootNode->mChildren[i], roots[i].index(no_index));
        }
    }
}

void GltfDocument::match_node(const aiScene& content, const aiNode& made, std::size_t index) {
    const Json& from = root_["nodes"][index];
    nodes_[&made] = &from;
    const std::size_t mesh = from["mesh"].index(no_index);
    const Json& primitives = root_["meshes"][mesh]["primitives"];
    if (made.mNumMeshes != primitives.size() || made.mNumChildren != from["children"].size()) {
        throw SceneFileError(path_ + ": node " + std::to_string(index) + ": its mesh or a child is not there");
    }
    for (unsigned i = 0; i < made.mNumMeshes; ++i) {
        const aiMesh& mesh_made = *content.mMeshes[made.mMeshes[i]];
        check_faces(mesh_made, mesh, i);
        const std::size_t material = primitives[i]["material"].index(no_index);
        materials_[mesh_made.mMaterialIndex] = &root_["materials"][material];
    }
    for (unsigned i = 0; i < made.mNumChildren; ++i) {
        match_node(content, *made.mChildren[i], from["children"][i].index(no_index));
    }
}

void GltfDocument::check_faces(const aiMesh& made, std::size_t mesh, std::size_t primitive) const {
    const Json& from = root_["meshes"][mesh]["primitives"][primitive];
    const std::size_t mode = from["mode"].index(4);
    if (mode < 4 || !from["indices"].is_number()) return;
    const std::size_t indices = root_["accessors"][from["indices"].index(no_index)]["count"].index(0);
    if (indices < 3) return;
    const std::size_t triangles = mode == 4 ? indices / 3 : indices - 2;
    if (made.mNumFaces < triangles) {
        throw SceneFileError(path_ + ": mesh " + std::to_string(mesh) + ", primitive " + std::to_string(primitive) +
                             ": " + std::to_string(triangles - made.mNumFaces) + " triangles of " +
                             std::to_string(triangles) + " have an index that is not smaller than the number of " +
                             "vertices, " + std::to_string(made.mNumVertices));
    }
}

const Json& GltfDocument::node(const aiNode& from) const {
    const auto found = nodes_.find(&from);
    return found == nodes_.end() ? nothing : *found->second;
}

const Json& GltfDocument::material(unsigned assimp_index) const {
    const auto found = materials_.find(assimp_index);
    return found == materials_.end() ? nothing : *found->second;
}

Affine<double> GltfDocument::transform(const aiNode& from) const {
    const Json& n = node(from);
    Affine<double> out;
    if (const Json& m = n["matrix"]; m.size() == 16) {  // by columns
        const auto column = [&](std::size_t c) {
            return Vec3d{m[4 * c].number(0), m[4 * c + 1].number(0), m[4 * c + 2].number(0)};
        };
        out.x = column(0), out.y = column(1), out.z = column(2), out.origin = column(3);
        return out;
    }
    const Json& q = n["rotation"];
    double x = q[std::size_t{0}].number(0), y = q[1].number(0), z = q[2].number(0), w = q[3].number(1);
    // Files round quaternions to seven digits, which would scale what they turn.
    if (const double size = std::sqrt(x * x + y * y + z * z + w * w); size > 0) {
        x /= size, y /= size, z /= size, w /= size;
    }
    const Vec3d scale = vec3d(n["scale"], {1, 1, 1});
    out.x = scale.x * Vec3d{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)};
    out.y = scale.y * Vec3d{2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)};
    out.z = scale.z * Vec3d{2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)};
    out.origin = vec3d(n["translation"], {0, 0, 0});
    return out;
}

}  // namespace realcam::io
