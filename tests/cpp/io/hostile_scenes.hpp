#pragma once
// Small glTF files with one faulty part, for test_hostile_*.cpp.

#include <chrono>
#include <string>
#include <vector>

#include "gltf_files.hpp"

namespace scene_files {

inline double seconds_of(const auto& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A glTF of one triangle in a data: address, whose parts can be replaced.
struct Tiny {
    std::string nodes = R"([{"mesh":0}])";
    std::string roots = "[0]";
    std::string primitive = R"("attributes":{"POSITION":0},"indices":1)";
    std::string position = R"("bufferView":0,"componentType":5126,"count":3,"type":"VEC3")";
    std::string indices = R"("bufferView":1,"componentType":5123,"count":3,"type":"SCALAR")";
    std::string more_accessors, more;

    std::string text() const {
        // Three corners (-1,-1,0), (1,-1,0), (0,1,0), and the indices 0, 1, 2.
        return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":)" + roots + R"(}],"nodes":)" + nodes +
               R"(,"meshes":[{"primitives":[{)" + primitive + R"(}]}],"accessors":[{)" + position + "},{" + indices +
               "}" + more_accessors +
               R"(],"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}],
               "buffers":[{"byteLength":42,"uri":"data:application/octet-stream;base64,)" +
               "AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAAAAABAAIA" + R"("}])" + more + "}";
    }
};

}  // namespace scene_files
