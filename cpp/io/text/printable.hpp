#pragma once
#include <string>
#include <string_view>

namespace realcam::io {

/// Any bytes as one line of valid UTF-8: control characters become blanks, and what is no UTF-8 the character U+FFFD.
std::string printable(std::string_view bytes);

/// The same between quotes, cut to some 60 bytes: what an error message repeats of its input.
std::string in_quotes(std::string_view bytes);

}  // namespace realcam::io
