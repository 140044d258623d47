#pragma once
#include <map>
#include <string>
#include <string_view>

#include "gltf_document.hpp"

namespace realcam::io {

/// Bytes of a glTF: from its .glb, from data: URIs, and from files beside it, each read on first use.
class GltfBuffers {
public:
    /// Both arguments must outlive the object.
    GltfBuffers(const GltfDocument& document, Checkpoint& checkpoint) : document_(document), checkpoint_(checkpoint) {}

    /// Returns all bytes of a buffer view, decoded if it is compressed. `reference`: JSON number with its index. Throws
    /// SceneFileError, whose message begins with `where`, if the view does not exist or the buffer has fewer bytes.
    std::string_view view(const Json& reference, const std::string& where);

private:
    /// Returns the part of a buffer that a buffer view, or the compression of one, specifies.
    std::string_view slice(const Json& view, const std::string& label);
    /// Returns the bytes of a buffer.
    std::string_view buffer(std::size_t index);
    /// Reads a buffer of `size` bytes from a data: URI or a file.
    std::string read_buffer(std::size_t index, std::size_t size);

    const GltfDocument& document_;
    Checkpoint& checkpoint_;
    std::map<std::size_t, std::string> read_;  ///< buffers that have been read, by index
    std::map<std::size_t, std::string> decoded_;  ///< compressed buffer views that have been decoded, by index
};

}  // namespace realcam::io
