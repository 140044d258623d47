#pragma once
#include <string>

namespace realcam::io {

/// Returns a message as one line for a terminal: control characters become blanks; words of more than 300 bytes and
/// lines of more than 2000, which only broken input has, lose their middle.
std::string one_line(const std::string& message);

}  // namespace realcam::io
