#pragma once
#include <string>

namespace realcam::io {

/// Returns the suffix of a file's name in lower case, with its dot: ".png". Empty if there is no suffix.
std::string suffix_of(const std::string& path);

}  // namespace realcam::io
