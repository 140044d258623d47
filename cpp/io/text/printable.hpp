#pragma once
#include <string>
#include <string_view>

namespace realcam::io {

/// Returns any bytes as one line of valid UTF-8: control characters become blanks, and invalid bytes become U+FFFD.
std::string printable(std::string_view bytes);

/// Returns the same in quotes, cut to about 60 bytes, to repeat input in error messages.
std::string in_quotes(std::string_view bytes);

}  // namespace realcam::io
