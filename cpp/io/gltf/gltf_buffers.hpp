#pragma once
#include <map>
#include <string>
#include <string_view>

#include "gltf_document.hpp"

namespace realcam::io {

/// The bytes of a glTF: of its .glb, of data: addresses, and of files beside it, each read when it is asked for.
class GltfBuffers {
public:
    /// Both arguments have to outlive it.
    GltfBuffers(const GltfDocument& document, Checkpoint& checkpoint) : document_(document), checkpoint_(checkpoint) {}

    /// All bytes of a buffer view. Throws SceneFileError, which begins with `where`, if there are not so many.
    std::string_view view(const Json& reference, const std::string& where);

private:
    std::string_view buffer(std::size_t number);
    std::string read_buffer(std::size_t number, std::size_t size);

    const GltfDocument& document_;
    Checkpoint& checkpoint_;
    std::map<std::size_t, std::string> read_;
};

}  // namespace realcam::io
