#pragma once
// GLB files with meshes compressed by Draco and by meshoptimizer's codecs, as the encoders of these libraries write
// them.

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#if REALCAM_HAS_DRACO
#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>
#endif
#if REALCAM_HAS_MESHOPT
#include <meshoptimizer.h>
#endif

#include "scene_seeds.hpp"

namespace realcam::fuzz {

/// Height field z = sin(3 x) cos(2 y) / 8 over the unit square, as a grid. Texture coordinates are x and y.
struct GridMesh {
    explicit GridMesh(int size) {
        for (int row = 0; row <= size; ++row)
            for (int column = 0; column <= size; ++column)
                add_vertex(float(column) / float(size), float(row) / float(size));
        for (int row = 0; row < size; ++row)
            for (int column = 0; column < size; ++column) {
                const auto a = static_cast<std::uint32_t>(row * (size + 1) + column);
                const auto above = a + static_cast<std::uint32_t>(size) + 1;
                for (const std::uint32_t i : {a, a + 1, above, a + 1, above + 1, above}) indices.push_back(i);
            }
    }

    std::size_t vertices() const { return uvs.size() / 2; }
    static float height(float x, float y) { return std::sin(3 * x) * std::cos(2 * y) / 8; }

    std::vector<float> positions, normals, uvs;  ///< three, three and two numbers for each vertex
    std::vector<std::uint32_t> indices;

private:
    void add_vertex(float x, float y) {
        const float slope_x = 3 * std::cos(3 * x) * std::cos(2 * y) / 8,
                    slope_y = -2 * std::sin(3 * x) * std::sin(2 * y) / 8;
        const float size = std::sqrt(1 + slope_x * slope_x + slope_y * slope_y);
        for (const float value : {x, y, height(x, y)}) positions.push_back(value);
        for (const float value : {-slope_x, -slope_y, 1.0f}) normals.push_back(value / size);
        for (const float value : {x, y}) uvs.push_back(value);
    }
};

/// JSON of a glTF with one mesh and a node that uses it. `more`: further members, with their leading comma.
inline std::string compressed_json(const std::string& primitive, const std::string& accessors, const std::string& views,
                                   const std::string& buffers, const std::string& more) {
    return R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{)" +
           primitive + R"(}]}],"accessors":[)" + accessors + R"(],"bufferViews":[)" + views + R"(],"buffers":[)" +
           buffers + "]" + more + "}";
}

/// JSON of an accessor. `view`: index of its bufferView; negative: it has none.
inline std::string accessor_json(int view, int component_type, std::size_t count, const char* type,
                                 bool is_normalised = false) {
    return "{" + (view < 0 ? "" : R"("bufferView":)" + std::to_string(view) + ",") + R"("componentType":)" +
           std::to_string(component_type) + R"(,"count":)" + std::to_string(count) + R"(,"type":")" + type + "\"" +
           (is_normalised ? R"(,"normalized":true)" : "") + "}";
}

#if REALCAM_HAS_DRACO

/// Coding of a Draco mesh. Numbers of bits: 0 for floats that are not quantised.
struct DracoCoding {
    bool is_edgebreaker = true;
    int position_bits = 11, normal_bits = 8, uv_bits = 0;
    int speed = 5;  ///< 0 (smallest) to 10 (fastest)
};

/// Returns the bytes of a Draco mesh. Its attributes have the ids 0, 1 and 2: positions, normals, texture coordinates.
inline std::string draco_bytes(const GridMesh& grid, const DracoCoding& coding) {
    draco::Mesh mesh;
    const auto points = static_cast<std::uint32_t>(grid.vertices());
    mesh.set_num_points(points);
    const auto add = [&](draco::GeometryAttribute::Type type, const std::vector<float>& numbers,
                         std::int8_t components) {
        draco::GeometryAttribute attribute;
        attribute.Init(type, nullptr, components, draco::DT_FLOAT32, false, components * sizeof(float), 0);
        const int id = mesh.AddAttribute(attribute, true, points);
        for (std::uint32_t i = 0; i < points; ++i)
            mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i),
                                                  numbers.data() + i * static_cast<std::uint32_t>(components));
    };
    add(draco::GeometryAttribute::POSITION, grid.positions, 3);
    add(draco::GeometryAttribute::NORMAL, grid.normals, 3);
    add(draco::GeometryAttribute::TEX_COORD, grid.uvs, 2);
    for (std::size_t i = 0; i < grid.indices.size(); i += 3)
        mesh.AddFace({draco::PointIndex(grid.indices[i]), draco::PointIndex(grid.indices[i + 1]),
                      draco::PointIndex(grid.indices[i + 2])});
    draco::ExpertEncoder encoder(mesh);
    encoder.SetEncodingMethod(coding.is_edgebreaker ? draco::MESH_EDGEBREAKER_ENCODING
                                                    : draco::MESH_SEQUENTIAL_ENCODING);
    encoder.SetSpeedOptions(coding.speed, coding.speed);
    const int bits[] = {coding.position_bits, coding.normal_bits, coding.uv_bits};
    for (int i = 0; i < 3; ++i)
        if (bits[i] > 0) encoder.SetAttributeQuantization(i, bits[i]);
    draco::EncoderBuffer buffer;
    return encoder.EncodeToBuffer(&buffer).ok() ? std::string(buffer.data(), buffer.size()) : std::string();
}

/// JSON of a glTF whose mesh is in KHR_draco_mesh_compression. `bytes`: number of compressed bytes.
inline std::string draco_json(const GridMesh& grid, std::size_t bytes) {
    const std::size_t count = grid.vertices();
    const std::string length = R"("byteLength":)" + std::to_string(bytes);
    return compressed_json(
        R"("attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"indices":3,"extensions":{"KHR_draco_mesh_compression":)"
        R"({"bufferView":0,"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2}}})",
        accessor_json(-1, 5126, count, "VEC3") + "," + accessor_json(-1, 5126, count, "VEC3") + "," +
            accessor_json(-1, 5126, count, "VEC2") + "," + accessor_json(-1, 5123, grid.indices.size(), "SCALAR"),
        R"({"buffer":0,)" + length + "}", "{" + length + "}",
        R"(,"extensionsUsed":["KHR_draco_mesh_compression"],"extensionsRequired":["KHR_draco_mesh_compression"])");
}

#endif

#if REALCAM_HAS_MESHOPT

/// Writes bufferViews in EXT_meshopt_compression.
class MeshoptWriter {
public:
    /// Adds a view of mode ATTRIBUTES. `numbers`: after its filter has been applied.
    template <class T>
    void add_attributes(const std::vector<T>& numbers, std::size_t stride, const char* filter = "NONE") {
        const std::size_t count = numbers.size() * sizeof(T) / stride;
        std::vector<unsigned char> coded(meshopt_encodeVertexBufferBound(count, stride));
        coded.resize(meshopt_encodeVertexBuffer(coded.data(), coded.size(), numbers.data(), count, stride));
        add(coded, count, stride, "ATTRIBUTES", filter);
    }
    /// Adds a view of indices of two bytes, of mode TRIANGLES or INDICES.
    void add_indices(const std::vector<std::uint32_t>& indices, std::size_t vertices, bool are_triangles) {
        std::vector<unsigned char> coded(are_triangles ? meshopt_encodeIndexBufferBound(indices.size(), vertices)
                                                       : meshopt_encodeIndexSequenceBound(indices.size(), vertices));
        meshopt_encodeIndexVersion(1);  // which the extension requires
        coded.resize(are_triangles
                         ? meshopt_encodeIndexBuffer(coded.data(), coded.size(), indices.data(), indices.size())
                         : meshopt_encodeIndexSequence(coded.data(), coded.size(), indices.data(), indices.size()));
        add(coded, indices.size(), 2, are_triangles ? "TRIANGLES" : "INDICES", "NONE");
    }

    std::string bytes;  ///< bytes of the compressed buffer
    std::string views;  ///< JSON of the bufferViews

    /// JSON of the compressed buffer, and of the declared one of the uncompressed bytes.
    std::string buffers() const {
        return R"({"byteLength":)" + std::to_string(bytes.size()) + R"(},{"byteLength":)" + std::to_string(decoded_) +
               R"(,"extensions":{"EXT_meshopt_compression":{"fallback":true}}})";
    }

private:
    void add(const std::vector<unsigned char>& coded, std::size_t count, std::size_t stride, const std::string& mode,
             const std::string& filter) {
        const auto range = [](int buffer, std::size_t offset, std::size_t length) {
            return R"("buffer":)" + std::to_string(buffer) + R"(,"byteOffset":)" + std::to_string(offset) +
                   R"(,"byteLength":)" + std::to_string(length);
        };
        const std::string byte_stride = R"(,"byteStride":)" + std::to_string(stride);
        views += (views.empty() ? "{" : ",{") + range(1, decoded_, count * stride) +
                 (mode == "ATTRIBUTES" ? byte_stride : "") + R"(,"extensions":{"EXT_meshopt_compression":{)" +
                 range(0, bytes.size(), coded.size()) + byte_stride + R"(,"count":)" + std::to_string(count) +
                 R"(,"mode":")" + mode + R"(","filter":")" + filter + "\"}}}";
        bytes.append(reinterpret_cast<const char*>(coded.data()), coded.size());
        bytes.resize((bytes.size() + 3) / 4 * 4);
        decoded_ += (count * stride + 3) / 4 * 4;
    }

    std::size_t decoded_ = 0;  ///< size of the uncompressed bytes
};

/// Bits of the filters of meshopt_grid: mantissas of positions, and components of normals and of rotations.
inline constexpr int kMeshoptPositionBits = 15, kMeshoptNormalBits = 8, kMeshoptRotationBits = 12;

/// Appends a fourth number to each group of three.
inline std::vector<float> with_fourth(const std::vector<float>& numbers, float fourth) {
    std::vector<float> out;
    for (std::size_t i = 0; i < numbers.size(); i += 3)
        out.insert(out.end(), {numbers[i], numbers[i + 1], numbers[i + 2], fourth});
    return out;
}

/// Adds the views of a grid: positions with the filter EXPONENTIAL, normals of bytes with OCTAHEDRAL, texture
/// coordinates of 16 bits, indices, and a rotation by 120 degrees about (1, 1, 1) and its inverse as 16-bit
/// quaternions, QUATERNION.
inline MeshoptWriter meshopt_grid(const GridMesh& grid, bool are_triangles) {
    MeshoptWriter writer;
    std::vector<std::uint32_t> exponential(grid.positions.size());
    meshopt_encodeFilterExp(exponential.data(), grid.vertices(), 12, kMeshoptPositionBits, grid.positions.data());
    writer.add_attributes(exponential, 12, "EXPONENTIAL");
    std::vector<std::int8_t> octahedral(4 * grid.vertices());
    meshopt_encodeFilterOct(octahedral.data(), grid.vertices(), 4, kMeshoptNormalBits,
                            with_fourth(grid.normals, 0).data());
    writer.add_attributes(octahedral, 4, "OCTAHEDRAL");
    std::vector<std::uint16_t> uvs;
    for (const float value : grid.uvs) uvs.push_back(static_cast<std::uint16_t>(std::lround(value * 65535)));
    writer.add_attributes(uvs, 4);
    writer.add_indices(grid.indices, grid.vertices(), are_triangles);
    const float rotations[] = {0.5f, 0.5f, 0.5f, 0.5f, -0.5f, -0.5f, -0.5f, 0.5f};
    std::vector<std::int16_t> quaternions(8);
    meshopt_encodeFilterQuat(quaternions.data(), 2, 8, kMeshoptRotationBits, rotations);
    writer.add_attributes(quaternions, 8, "QUATERNION");
    writer.add_attributes(std::vector<float>{0, 1}, 4);
    return writer;
}

/// JSON of a glTF whose mesh and animation are in EXT_meshopt_compression.
inline std::string meshopt_json(const GridMesh& grid, const MeshoptWriter& writer) {
    const std::size_t count = grid.vertices();
    return compressed_json(
        R"("attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"indices":3)",
        accessor_json(0, 5126, count, "VEC3") + "," + accessor_json(1, 5120, count, "VEC3", true) + "," +
            accessor_json(2, 5123, count, "VEC2", true) + "," + accessor_json(3, 5123, grid.indices.size(), "SCALAR") +
            "," + accessor_json(4, 5122, 2, "VEC4", true) + "," + accessor_json(5, 5126, 2, "SCALAR"),
        writer.views, writer.buffers(),
        R"(,"animations":[{"channels":[{"sampler":0,"target":{"node":0,"path":"rotation"}}],)"
        R"("samplers":[{"input":5,"output":4}]}],"extensionsUsed":["EXT_meshopt_compression","KHR_mesh_quantization"],)"
        R"("extensionsRequired":["EXT_meshopt_compression","KHR_mesh_quantization"])");
}

#endif

}  // namespace realcam::fuzz
