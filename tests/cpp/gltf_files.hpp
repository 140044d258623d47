#pragma once
// Small glTF files for the tests: one triangle, and nodes that use it.

#include <string>
#include <vector>

#include "scene_files.hpp"

namespace scene_files {

// A triangle (0,0,0), (1,0,0), (0,1,0) that faces +z, with normals and texture coordinates, in a file tri.bin.
inline std::string triangle_bytes(std::vector<std::uint16_t> indices = {0, 1, 2}, float x1 = 1) {
    const float values[] = {0, 0, 0, x1, 0, 0, 0, 1, 0, /*normals*/ 0, 0, 1, 0, 0, 1, 0, 0, 1, /*uv*/ 0, 1, 1, 1, 0, 0};
    std::string out(reinterpret_cast<const char*>(values), sizeof values);
    out.append(reinterpret_cast<const char*>(indices.data()), 2 * indices.size());
    return out + std::string(2, '\0');
}

inline std::string gltf(const std::string& nodes, const std::string& roots, const std::string& more = "",
                        const std::string& attributes = R"(,"NORMAL":1,"TEXCOORD_0":2)", std::size_t indices = 3) {
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":)" + roots + R"(}],"nodes":)" + nodes +
           R"(,"meshes":[{"name":"tri","primitives":[{"attributes":{"POSITION":0)" + attributes +
           R"(},"indices":3,"material":0}]},
               {"primitives":[{"attributes":{"POSITION":0)" +
           attributes + R"(},"indices":3}]}],
           "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
             {"bufferView":1,"componentType":5126,"count":3,"type":"VEC3"},
             {"bufferView":2,"componentType":5126,"count":3,"type":"VEC2"},
             {"bufferView":3,"componentType":5123,"count":)" +
           std::to_string(indices) + R"(,"type":"SCALAR"}],
           "bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":36},
             {"buffer":0,"byteOffset":72,"byteLength":24},
             {"buffer":0,"byteOffset":96,"byteLength":)" +
           std::to_string(2 * indices) + R"(}],
           "buffers":[{"byteLength":)" +
           std::to_string(98 + 2 * indices) + R"(,"uri":"tri.bin"}])" +
           (has(more, "\"materials\"") ? "" : R"(,"materials":[{"name":"plain"}])") + more + "}";
}

}  // namespace scene_files
