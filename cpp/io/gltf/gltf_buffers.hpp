#pragma once
#include <map>
#include <string>
#include <string_view>

#include "gltf_document.hpp"

namespace realcam::io {

/// Bytes of a glTF: from its .glb, from data: URIs, and from files beside it, each read on first use.
class GltfBuffers {
public:
    /// Both arguments have to outlive the object.
    GltfBuffers(const GltfDocument& document, Checkpoint& checkpoint) : document_(document), checkpoint_(checkpoint) {}

    /// Returns all bytes of a buffer view. Throws SceneFileError, which begins with `where`, if the buffer has fewer.
    std::string_view view(const Json& reference, const std::string& where);

private:
    std::string_view buffer(std::size_t number);
    std::string read_buffer(std::size_t number, std::size_t size);

    const GltfDocument& document_;
    Checkpoint& checkpoint_;
    std::map<std::size_t, std::string> read_;
};

}  // namespace realcam::io
