#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "../../checkpoint.hpp"
#include "../text/json.hpp"

namespace realcam::io {

/// JSON of a .gltf or .glb, and the binary chunk of a .glb.
class GltfDocument {
public:
    /// Reads the file. Throws FileError, and SceneFileError if it is not valid JSON or requires an unsupported
    /// extension.
    GltfDocument(const std::string& path, Checkpoint& checkpoint);

    const std::string& path() const { return path_; }
    const Json& root() const { return root_; }
    /// Returns the binary chunk of a .glb; empty if there is no such chunk.
    std::string_view binary_chunk() const {
        return binary_size_ > 0 ? std::string_view(file_).substr(binary_begin_, binary_size_) : "";
    }

    /// Throws SceneFileError "PATH: message".
    [[noreturn]] void fail(const std::string& message) const;

    /// Returns the index that `reference` gives in a list of the root; std::nullopt if there is no reference. Throws
    /// SceneFileError, which begins with `where`, if there is no such element.
    std::optional<std::size_t> find(const char* list, const Json& reference, const std::string& where) const;

private:
    std::string_view json_text();

    std::string path_;
    std::string file_;
    std::size_t binary_begin_ = 0, binary_size_ = 0;
    Json root_;
};

/// Returns the name of an element for messages: "mesh 3", followed by its own name if it has one.
std::string gltf_label(const std::string& kind, std::size_t number, const Json& element);

}  // namespace realcam::io
