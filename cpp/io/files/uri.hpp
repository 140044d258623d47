#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace realcam::io {

/// "my%20wood.png" as "my wood.png".
std::string percent_decoded(std::string_view text);

/// Whether an address holds its bytes itself.
inline bool is_data_uri(std::string_view uri) {
    return uri.starts_with("data:");
}

/// The bytes of "data:KIND;base64,TEXT"; nothing where the text is no base64, or spelt in another way.
std::optional<std::string> data_of_uri(std::string_view uri);

}  // namespace realcam::io
