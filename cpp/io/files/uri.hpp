#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace realcam::io {

/// Decodes percent escapes: "my%20wood.png" becomes "my wood.png".
std::string percent_decoded(std::string_view text);

/// True if a URI contains its data itself.
inline bool is_data_uri(std::string_view uri) {
    return uri.starts_with("data:");
}

/// Returns the bytes of "data:KIND;base64,TEXT"; std::nullopt if the text is not base64, or the URI has another form.
std::optional<std::string> data_of_uri(std::string_view uri);

}  // namespace realcam::io
