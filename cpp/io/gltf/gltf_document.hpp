#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "../../checkpoint.hpp"
#include "../text/json.hpp"

namespace realcam::io {

/// The JSON of a .gltf or .glb, and what lies behind it in a .glb.
class GltfDocument {
public:
    /// Throws FileError, and SceneFileError: no JSON, or an extension is required that is not read.
    GltfDocument(const std::string& path, Checkpoint& checkpoint);

    const std::string& path() const { return path_; }
    const Json& root() const { return root_; }
    /// The second chunk of a .glb; empty where there is none.
    std::string_view binary_chunk() const {
        return binary_size_ > 0 ? std::string_view(file_).substr(binary_begin_, binary_size_) : "";
    }

    /// Throws SceneFileError "PATH: message".
    [[noreturn]] void fail(const std::string& message) const;

    /// The element of a list of the root that `reference` numbers; nothing where there is no reference. Throws
    /// SceneFileError, which begins with `where`, if there is no such element.
    std::optional<std::size_t> find(const char* list, const Json& reference, const std::string& where) const;

private:
    std::string_view json_text();

    std::string path_;
    std::string file_;
    std::size_t binary_begin_ = 0, binary_size_ = 0;
    Json root_;
};

/// How messages name an element: "mesh 3", and its name if it has one.
std::string gltf_label(const std::string& kind, std::size_t number, const Json& element);

}  // namespace realcam::io
