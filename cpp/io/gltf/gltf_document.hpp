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
    /// Parses the bytes of a .gltf or .glb; `path` names it in messages. Throws SceneFileError if they are not valid
    /// glTF 2.0 or require an unsupported extension.
    GltfDocument(const std::string& path, std::string bytes, Checkpoint& checkpoint);

    const std::string& path() const { return path_; }
    /// The whole JSON object.
    const Json& root() const { return root_; }
    /// Returns the binary chunk of a .glb; empty if there is no such chunk.
    std::string_view binary_chunk() const {
        return binary_size_ > 0 ? std::string_view(file_).substr(binary_begin_, binary_size_) : "";
    }

    /// Throws SceneFileError "PATH: message".
    [[noreturn]] void fail(const std::string& message) const;

    /// Returns the index that a reference, a JSON number, specifies in a list of the root, such as "meshes";
    /// std::nullopt if `reference` is null. Throws SceneFileError, whose message begins with `where`, if there is no
    /// such element.
    std::optional<std::size_t> find(const char* list, const Json& reference, const std::string& where) const;

private:
    /// Returns the JSON text of the file and sets the range of the binary chunk.
    std::string_view json_text();

    std::string path_;
    std::string file_;  ///< the file's bytes; empty if it has no binary chunk
    std::size_t binary_begin_ = 0, binary_size_ = 0;  ///< range of the binary chunk in file_
    Json root_;
};

/// Returns the label of an element for messages: kind and index, as "mesh 3", followed by its name if it has one.
std::string gltf_label(const std::string& kind, std::size_t index, const Json& element);

}  // namespace realcam::io
