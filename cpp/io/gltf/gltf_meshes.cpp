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

/// Modes of primitives in glTF; those below kFirstOfTriangles are points and lines.
enum Mode : std::size_t { kFirstOfTriangles = 4, kTriangles = kGltfTriangles, kStrip = 5, kFan = 6 };

constexpr std::size_t kBytesPerVertex = sizeof(Vec3d) + sizeof(Vec3f) + sizeof(Vec2f);

/// Groups numbers, three at a time, into vectors.
template <class T>
std::vector<Vec3<T>> vectors_of(const std::vector<float>& numbers) {
    std::vector<Vec3<T>> out(numbers.size() / 3);
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = static_cast<Vec3<T>>(Vec3f{numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]});
    return out;
}

}  // namespace

std::vector<double> target_weights_of(const Json& list) {
    std::vector<double> weights;
    for (std::size_t i = 0; i < list.size(); ++i) weights.push_back(list[i].number(0));
    return weights;
}

GltfMeshes::Range GltfMeshes::add(std::size_t mesh, const GltfShape& shape) {
    const Json& from = document_.root()["meshes"][mesh];
    if (const auto known = added_.find(mesh); shape.is_plain() && known != added_.end()) return known->second;
    const Json& primitives = from["primitives"];
    const Range range{static_cast<std::uint32_t>(scene_.meshes.size()), static_cast<std::uint32_t>(primitives.size())};
    const std::vector<double> weights =
        shape.target_weights.empty() ? target_weights_of(from["weights"]) : shape.target_weights;
    for (std::size_t p = 0; p < primitives.size(); ++p) {
        std::string label = gltf_label("mesh", mesh, from);
        if (primitives.size() > 1) label += ", primitive " + std::to_string(p);
        const std::uint32_t material = material_of(primitives[p], label);
        add_primitive({primitives[p], weights, shape, label, material});
    }
    if (shape.is_plain()) added_.emplace(mesh, range);
    return range;
}

std::uint32_t GltfMeshes::material_of(const Json& primitive, const std::string& label) {
    if (const auto index = document_.find("materials", primitive["material"], label + ": its material"))
        return static_cast<std::uint32_t>(*index);
    if (!default_material_) {
        default_material_ = static_cast<std::uint32_t>(scene_.materials.size());
        scene_.materials.emplace_back();
    }
    return *default_material_;
}

std::vector<std::string> GltfMeshes::attribute_names(const Primitive& primitive) const {
    std::vector<std::string> names = {"POSITION", "NORMAL", "COLOR_0"};
    for (const std::uint32_t set : scene_.materials[primitive.material].uv_sets())
        names.push_back("TEXCOORD_" + std::to_string(set));
    for (std::size_t set = 0; set < kMaxJointSets; ++set)
        for (const char* name : {"JOINTS_", "WEIGHTS_"}) names.push_back(name + std::to_string(set));
    return names;
}

void GltfMeshes::add_primitive(const Primitive& primitive) {
    accessors_.set_decoded(
        decode_primitive(document_, buffers_, primitive.json, attribute_names(primitive), primitive.label));
    FileMesh mesh;
    mesh.label = primitive.label;
    mesh.vertices = vertices_of(primitive);
    mesh.triangles = read_triangles(primitive, scene_.vertices[mesh.vertices].positions.size());
    check_memory(mesh);
    scene_.meshes.push_back(std::move(mesh));
}

void GltfMeshes::check_memory(const FileMesh& mesh) {
    bytes_ += mesh.triangles.size() * sizeof(Triangle);
    if (mesh.vertices + 1 == scene_.vertices.size())
        bytes_ += scene_.vertices.back().positions.size() * kBytesPerVertex;
    if (bytes_ < next_check_) return;
    if (const std::string why = too_much_memory(bytes_ - next_check_ / 2); !why.empty())
        document_.fail("its meshes need " + why);
    next_check_ = 2 * bytes_;
}

double GltfMeshes::deformed_bytes(std::size_t mesh, bool is_skinned, bool has_moving_targets) {
    const auto [known, is_new] = deformed_bytes_.try_emplace({mesh, is_skinned, has_moving_targets}, 0.0);
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
        // Twice as well, with positions and normals.
        if (has_moving_targets)
            known->second += 4 * sizeof(Vec3f) * vertices * static_cast<double>(primitive["targets"].size());
    }
    return known->second;
}

void GltfMeshes::check_deformed_bytes(double bytes) const {
    constexpr double kUncheckedBytes = 1 << 28, kMaxBytes = 1e18;
    if (bytes < kUncheckedBytes) return;
    if (const std::string why = too_much_memory(static_cast<std::uint64_t>(std::min(bytes, kMaxBytes))); !why.empty())
        document_.fail("its meshes, of which nodes with skins or weights have their own, need " + why);
}

std::uint32_t GltfMeshes::vertices_of(const Primitive& primitive) {
    const Json& attributes = primitive.json["attributes"];
    const std::vector<std::uint32_t> sets = scene_.materials[primitive.material].uv_sets();
    const auto uvs_of = [&](std::size_t i) -> const Json& {
        return attributes[i < sets.size() ? "TEXCOORD_" + std::to_string(sets[i]) : ""];
    };
    constexpr std::size_t kNone = static_cast<std::size_t>(-1);
    const Attributes key{attributes["POSITION"].index(kNone), attributes["NORMAL"].index(kNone), uvs_of(0).index(kNone),
                         uvs_of(1).index(kNone), attributes["COLOR_0"].index(kNone)};
    const bool may_share = !primitive.shape.is_skinned() && primitive.json["targets"].is_null();
    if (const auto known = shared_vertices_.find(key); may_share && known != shared_vertices_.end())
        return known->second;
    const auto index = static_cast<std::uint32_t>(scene_.vertices.size());
    scene_.vertices.push_back(read_vertices(primitive, uvs_of(0), uvs_of(1)));
    if (may_share) shared_vertices_.emplace(key, index);
    return index;
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
    read_targets(primitive, out);
    if (primitive.shape.is_skinned()) {
        const std::optional<JointMaps>& joints = primitive.shape.joints;
        out.joints = read_joint_weights(document_, accessors_, attributes, count,
                                        joints ? joints->size() : primitive.shape.moving_joints, label);
        if (joints) apply_skin(out.positions, out.normals, std::exchange(out.joints, {}), *joints, checkpoint_);
    }
    for (std::size_t v = 0; v < count; ++v) {
        if (!in_reach(out.positions[v]) && !is_finite(out.positions[v]))
            document_.fail(label + ": vertex " + std::to_string(v) + ": " + coordinates_error(out.positions[v]));
    }
    return out;
}

std::vector<VertexColor> GltfMeshes::read_colours(const Json& reference, const std::string& where) {
    const Json& accessors = document_.root()["accessors"];
    const Json& accessor = accessors[reference.index(accessors.size())];
    const std::size_t components = accessor["type"].text() == "VEC4" ? 4 : 3, type = accessor["componentType"].index(0);
    const std::vector<float> numbers = accessors_.numbers(reference, components == 4 ? "VEC4" : "VEC3", where);
    // Integers must be normalised; if a file does not declare this, they are normalised here.
    const bool is_normalised = accessor["normalized"].is_true();
    const float unit = is_normalised || (type != kGltfUnsignedByte && type != kGltfUnsignedShort) ? 1.0f
                       : type == kGltfUnsignedByte                                                ? 255.0f
                                                                                                  : 65535.0f;
    const auto fraction = [&](std::size_t i) {
        const float value = numbers[i] / unit;
        return value > 0 ? std::min(value, 1.0f) : 0.0f;
    };
    std::vector<VertexColor> out;
    out.reserve(numbers.size() / components);
    for (std::size_t i = 0; i < numbers.size(); i += components)
        out.push_back({{fraction(i), fraction(i + 1), fraction(i + 2)}, components == 4 ? fraction(i + 3) : 1.0f});
    return out;
}

MorphTarget GltfMeshes::read_target(const Primitive& primitive, std::size_t target, std::size_t vertices) {
    const std::string where = primitive.label + ": target " + std::to_string(target);
    const Json& json = primitive.json["targets"][target];
    const auto deltas = [&](const char* name) {
        if (json[name].is_null()) return std::vector<Vec3f>();
        const std::vector<Vec3f> out = vectors_of<float>(accessors_.numbers(json[name], "VEC3", where));
        check_count(out.size(), vertices, where);
        return out;
    };
    return {deltas("POSITION"), deltas("NORMAL")};
}

void GltfMeshes::read_targets(const Primitive& primitive, FileVertices& vertices) {
    const std::size_t count = vertices.positions.size(), targets = primitive.json["targets"].size();
    for (std::size_t t = 0; t < targets; ++t) {
        if (t < primitive.shape.moving_targets) {
            vertices.targets.push_back(read_target(primitive, t, count));
        } else if (t < primitive.target_weights.size() && primitive.target_weights[t] != 0) {
            add_target(vertices.positions, vertices.normals, read_target(primitive, t, count),
                       primitive.target_weights[t]);
        }
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
    const std::vector<std::uint32_t> indices = read_indices(primitive, vertices);
    const std::size_t step = mode == kTriangles ? 3 : 1;
    triangles.reserve(indices.size() / step);
    for (std::size_t k = 0; k + 2 < indices.size(); k += step) {
        checkpoint_.pass();
        // Every second triangle of a strip has the opposite orientation.
        const std::size_t odd = mode == kStrip ? k % 2 : 0;
        const std::uint32_t first = mode == kFan ? indices[0] : indices[k + odd];
        triangles.push_back({{first, indices[k + 1 - odd], indices[k + 2]}, primitive.material});
    }
    return triangles;
}

}  // namespace realcam::io
