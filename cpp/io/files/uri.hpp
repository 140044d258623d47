#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace realcam::io {

/// Returns the suffix of a file name in lower case, with its dot, such as ".png"; empty if there is none.
std::string suffix_of(const std::string& path);

/// Returns the path of the regular file that a scene file refers to by a name. Files from other machines have names
/// with backslashes and paths that exist only there; in that case a file of the same name beside the scene is found.
/// Returns std::nullopt if there is no such file.
std::optional<std::string> find_beside(const std::string& scene_path, const std::string& name);

/// Decodes percent escapes: "my%20wood.png" becomes "my wood.png".
std::string percent_decoded(std::string_view text);

/// True for a data URI, which contains the data itself.
inline bool is_data_uri(std::string_view uri) {
    return uri.starts_with("data:");
}

/// Returns the bytes of "data:KIND;base64,TEXT"; std::nullopt if the text is not base64, or the URI has another form.
std::optional<std::string> data_of_uri(std::string_view uri);

}  // namespace realcam::io
