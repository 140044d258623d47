#include "gltf_meshes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "../../error.hpp"
#include "../../scene/scene_checks.hpp"
#include "../files/regular_file.hpp"

namespace realcam::io {
namespace {

enum Mode : std::size_t { kFirstOfTriangles = 4, kTriangles = 4, kStrip = 5, kFan = 6 };

constexpr std::size_t kBytesPerVertex = sizeof(Vec3d) + sizeof(Vec3f) + sizeof(Vec2f);

template <class T>
std::vector<Vec3<T>> vectors_of(const std::vector<float>& numbers) {
    std::vector<Vec3<T>> out(numbers.size() / 3);
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = static_cast<Vec3<T>>(Vec3f{numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]});
    return out;
}

}  // namespace

GltfMeshes::Range GltfMeshes::add(std::size_t mesh, const Json& node_weights, const std::optional<JointMaps>& joints) {
    const Json& from = document_.root()["meshes"][mesh];
    const bool is_plain = !joints && node_weights.is_null();
    if (const auto known = added_.find(mesh); is_plain && known != added_.end()) return known->second;
    const Json& primitives = from["primitives"];
    const Range range{static_cast<std::uint32_t>(scene_.meshes.size()), static_cast<std::uint32_t>(primitives.size())};
    for (std::size_t p = 0; p < primitives.size(); ++p) {
        std::string label = gltf_label("mesh", mesh, from);
        if (primitives.size() > 1) label += ", primitive " + std::to_string(p);
        const std::uint32_t material = material_of(primitives[p], label);
        add_primitive(
            {primitives[p], node_weights.is_null() ? from["weights"] : node_weights, joints, label, material});
    }
    if (is_plain) added_.emplace(mesh, range);
    return range;
}

std::uint32_t GltfMeshes::material_of(const Json& primitive, const std::string& label) {
    if (const auto number = document_.find("materials", primitive["material"], label + ": its material"))
        return static_cast<std::uint32_t>(*number);
    if (!default_material_) {
        default_material_ = static_cast<std::uint32_t>(scene_.materials.size());
        scene_.materials.emplace_back();
    }
    return *default_material_;
}

/// Throws SceneFileError if a primitive exists only in a compressed form: accessors without bytes would be read as 0.
/// Files may have an uncompressed form in addition.
void GltfMeshes::check_compression(const Primitive& primitive) const {
    constexpr const char* kDraco = "KHR_draco_mesh_compression";
    if (primitive.json["extensions"][kDraco].is_null()) return;
    const Json& accessors = document_.root()["accessors"];
    for (const Json* reference : {&primitive.json["attributes"]["POSITION"], &primitive.json["indices"]}) {
        const Json& accessor = accessors[reference->index(accessors.size())];
        if (accessor.is_null() || !accessor["bufferView"].is_null() || !accessor["sparse"].is_null()) continue;
        document_.fail(primitive.label + ": its triangles are in the glTF extension " + kDraco +
                       ", which is not read; export it without compression");
    }
}

void GltfMeshes::add_primitive(const Primitive& primitive) {
    check_compression(primitive);
    FileMesh mesh;
    mesh.label = primitive.label;
    mesh.vertices = vertices_of(primitive);
    mesh.triangles = read_triangles(primitive, scene_.vertices[mesh.vertices].positions.size());
    check_memory(mesh);
    scene_.meshes.push_back(std::move(mesh));
}

/// Throws SceneFileError if the meshes need more memory than is free: in a file of a megabyte, a thousand meshes may
/// repeat a million vertices.
void GltfMeshes::check_memory(const FileMesh& mesh) {
    bytes_ += mesh.triangles.size() * sizeof(Triangle);
    if (mesh.vertices + 1 == scene_.vertices.size())
        bytes_ += scene_.vertices.back().positions.size() * kBytesPerVertex;
    if (bytes_ < next_check_) return;
    if (const std::string why = too_much_memory(bytes_ - next_check_ / 2); !why.empty())
        document_.fail("its meshes need " + why);
    next_check_ = 2 * bytes_;
}

double GltfMeshes::bytes_of_own(std::size_t mesh, bool is_skinned) {
    const auto [known, is_new] = own_bytes_.try_emplace({mesh, is_skinned}, 0.0);
    if (!is_new) return known->second;
    const Json &accessors = document_.root()["accessors"], &primitives = document_.root()["meshes"][mesh]["primitives"];
    const auto count_of = [&](const Json& accessor) {
        return static_cast<double>(accessors[accessor.index(accessors.size())]["count"].index(0));
    };
    for (std::size_t p = 0; p < primitives.size(); ++p) {
        checkpoint_.pass();
        const Json& primitive = primitives[p];
        const double vertices = count_of(primitive["attributes"]["POSITION"]);
        const double corners = primitive["indices"].is_null() ? vertices : count_of(primitive["indices"]);
        const std::size_t mode = primitive["mode"].index(kTriangles);
        const double triangles = mode < kFirstOfTriangles ? 0 : mode == kTriangles ? corners / 3 : corners;
        // Twice: here, and in the flattened scene.
        known->second += 2 * sizeof(Triangle) * triangles;
        if (is_skinned || !primitive["targets"].is_null()) known->second += kBytesPerVertex * vertices;
    }
    return known->second;
}

void GltfMeshes::check_promise(double bytes) const {
    constexpr double kAlwaysThere = 1 << 28, kMost = 1e18;
    if (bytes < kAlwaysThere) return;
    if (const std::string why = too_much_memory(static_cast<std::uint64_t>(std::min(bytes, kMost))); !why.empty())
        document_.fail("its meshes, of which nodes with skins or weights have their own, need " + why);
}

std::uint32_t GltfMeshes::vertices_of(const Primitive& primitive) {
    const Json& attributes = primitive.json["attributes"];
    const std::vector<std::uint32_t> sets = scene_.materials[primitive.material].uv_sets();
    const auto uvs_of = [&](std::size_t i) -> const Json& {
        return attributes[i < sets.size() ? "TEXCOORD_" + std::to_string(sets[i]) : ""];
    };
    constexpr std::size_t none = static_cast<std::size_t>(-1);
    const Attributes key{attributes["POSITION"].index(none), attributes["NORMAL"].index(none), uvs_of(0).index(none),
                         uvs_of(1).index(none), attributes["COLOR_0"].index(none)};
    const bool may_share = !primitive.joints && primitive.json["targets"].is_null();
    if (const auto known = shared_vertices_.find(key); may_share && known != shared_vertices_.end())
        return known->second;
    const auto number = static_cast<std::uint32_t>(scene_.vertices.size());
    scene_.vertices.push_back(read_vertices(primitive, uvs_of(0), uvs_of(1)));
    if (may_share) shared_vertices_.emplace(key, number);
    return number;
}

void GltfMeshes::check_count(std::size_t count, std::size_t vertices, const std::string& where) const {
    if (count != vertices)
        document_.fail(where + ": has " + std::to_string(count) + " elements for " + std::to_string(vertices) +
                       " vertices; expected one for each");
}

FileVertices GltfMeshes::read_vertices(const Primitive& primitive, const Json& uvs, const Json& second_uvs) {
    const Json& attributes = primitive.json["attributes"];
    const std::string& label = primitive.label;
    FileVertices out;
    out.positions = vectors_of<double>(accessors_.numbers(attributes["POSITION"], "VEC3", label + ": POSITION"));
    const std::size_t count = out.positions.size();
    if (!attributes["NORMAL"].is_null()) {
        out.normals = vectors_of<float>(accessors_.numbers(attributes["NORMAL"], "VEC3", label + ": NORMAL"));
        check_count(out.normals.size(), count, label + ": NORMAL");
    }
    for (const auto& [json, list] : {std::pair(&uvs, &out.uvs), std::pair(&second_uvs, &out.second_uvs)}) {
        if (json->is_null()) continue;
        const std::vector<float> numbers = accessors_.numbers(*json, "VEC2", label + ": TEXCOORD");
        check_count(numbers.size() / 2, count, label + ": TEXCOORD");
        for (std::size_t i = 0; i < count; ++i) list->push_back({numbers[2 * i], 1 - numbers[2 * i + 1]});
    }
    if (!attributes["COLOR_0"].is_null()) {
        out.colours = read_colours(attributes["COLOR_0"], label + ": COLOR_0");
        check_count(out.colours.size(), count, label + ": COLOR_0");
    }
    add_targets(primitive, out);
    if (primitive.joints) {
        const JointWeights weights =
            read_joint_weights(document_, accessors_, attributes, count, primitive.joints->size(), label);
        apply_skin(out, weights, *primitive.joints, checkpoint_);
    }
    for (std::size_t v = 0; v < count; ++v) {
        if (!in_reach(out.positions[v]) && !is_finite(out.positions[v]))
            document_.fail(label + ": vertex " + std::to_string(v) + ": " + why_out_of_reach(out.positions[v]));
    }
    return out;
}

/// Reads colours, which are linear, with or without alpha, and between 0 and 1.
std::vector<VertexColor> GltfMeshes::read_colours(const Json& reference, const std::string& where) {
    const Json& accessors = document_.root()["accessors"];
    const Json& accessor = accessors[reference.index(accessors.size())];
    const std::size_t components = accessor["type"].text() == "VEC4" ? 4 : 3, type = accessor["componentType"].index(0);
    const std::vector<float> numbers = accessors_.numbers(reference, components == 4 ? "VEC4" : "VEC3", where);
    // Whole numbers must be normalised; if a file does not say so, they are normalised nevertheless.
    const bool is_forgotten = !accessor["normalized"].is_true();
    const float unit = !is_forgotten || (type != 5121 && type != 5123) ? 1.0f : type == 5121 ? 255.0f : 65535.0f;
    const auto share = [&](std::size_t i) {
        const float value = numbers[i] / unit;
        return value > 0 ? std::min(value, 1.0f) : 0.0f;
    };
    std::vector<VertexColor> out;
    out.reserve(numbers.size() / components);
    for (std::size_t i = 0; i < numbers.size(); i += components)
        out.push_back({{share(i), share(i + 1), share(i + 2)}, components == 4 ? share(i + 3) : 1.0f});
    return out;
}

/// Applies the morph targets with the file's weights.
void GltfMeshes::add_targets(const Primitive& primitive, FileVertices& vertices) {
    const Json& targets = primitive.json["targets"];
    for (std::size_t t = 0; t < targets.size(); ++t) {
        const double weight = primitive.weights[t].number(0);
        if (weight == 0) continue;
        const std::string where = primitive.label + ": target " + std::to_string(t);
        const auto deltas = [&](const char* name) {
            if (targets[t][name].is_null()) return std::vector<Vec3d>();
            const std::vector<Vec3d> out = vectors_of<double>(accessors_.numbers(targets[t][name], "VEC3", where));
            check_count(out.size(), vertices.positions.size(), where);
            return out;
        };
        const std::vector<Vec3d> moves = deltas("POSITION"), turns = deltas("NORMAL");
        for (std::size_t v = 0; v < moves.size(); ++v) vertices.positions[v] += weight * moves[v];
        if (vertices.normals.empty()) continue;
        for (std::size_t v = 0; v < turns.size(); ++v) vertices.normals[v] += static_cast<Vec3f>(weight * turns[v]);
    }
}

std::vector<std::uint32_t> GltfMeshes::read_indices(const Primitive& primitive, std::size_t vertices) {
    std::vector<std::uint32_t> indices;
    if (primitive.json["indices"].is_null()) {
        indices.resize(vertices);
        std::iota(indices.begin(), indices.end(), 0u);
        return indices;
    }
    indices = accessors_.integers(primitive.json["indices"], "SCALAR", primitive.label + ": indices");
    for (const std::uint32_t index : indices)
        if (index >= vertices)
            document_.fail(primitive.label + ": index " + std::to_string(index) +
                           " is not smaller than the number of vertices, " + std::to_string(vertices));
    return indices;
}

std::vector<Triangle> GltfMeshes::read_triangles(const Primitive& primitive, std::size_t vertices) {
    const Json& mode_json = primitive.json["mode"];
    const std::size_t mode = mode_json.is_null() ? kTriangles : mode_json.index(static_cast<std::size_t>(-1));
    if (mode > kFan) document_.fail(primitive.label + ": its mode must be a number from 0 to 6");
    std::vector<Triangle> triangles;
    if (mode < kFirstOfTriangles) return triangles;  // points and lines
    const std::vector<std::uint32_t> i = read_indices(primitive, vertices);
    const std::size_t step = mode == kTriangles ? 3 : 1;
    triangles.reserve(i.size() / step);
    for (std::size_t k = 0; k + 2 < i.size(); k += step) {
        checkpoint_.pass();
        // Every second triangle of a strip has the opposite orientation.
        const std::size_t odd = mode == kStrip ? k % 2 : 0;
        const std::uint32_t first = mode == kFan ? i[0] : i[k + odd];
        triangles.push_back({{first, i[k + 1 - odd], i[k + 2]}, primitive.material});
    }
    return triangles;
}

}  // namespace realcam::io
